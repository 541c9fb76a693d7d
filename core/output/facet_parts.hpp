// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts into which its segments divide a facet of a Domain (input/domain_parts.hpp): which facets of the input cover each,
// and which part a subfacet of a finished mesh lies in. Near-linear; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "input/domain_parts.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

class FacetParts {
 public:
  explicit FacetParts(const Domain<3>& domain);  ///< which must outlive it

  /// The part of each subfacet. @pre the entities of subsegments and subfacets are of the Domain
  std::vector<std::uint32_t> parts_of_subfacets(const OutputMesh<3>& mesh) const;
  /// Facets of the input that cover a part, or some of it: indices in Plc::facets, ascending.
  std::span<const std::uint32_t> inputs(std::uint32_t part) const {
    return std::span(inputs_).subspan(begin_[part], begin_[part + 1] - begin_[part]);
  }

 private:
  void list_inputs();
  std::vector<std::uint32_t> mixed_inputs(EntityId f) const;

  const Domain<3>& domain_;
  DomainParts parts_;
  std::vector<std::uint32_t> begin_;  // of each part, and one more: into inputs_
  std::vector<std::uint32_t> inputs_;
};

}  // namespace pgdr::detail
