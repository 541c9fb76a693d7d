// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What entities of a Domain are called in reasons: by what was given, which is all that their reader has. A facet is called by
// that of its given triangles at which it meets the other entity at the angle that is stated.
#pragma once

#include <array>
#include <vector>

#include "input/sharp_angles.hpp"
#include "pgdr/output_mesh.hpp"
#include "reasons/poor_reasons.hpp"

namespace pgdr {

template <int D>
class GivenNames {
 public:
  /// @param mesh of the Domain. @param meshed its parts of facets. All must outlive it.
  GivenNames(const Domain<D>& domain, const OutputMesh<D>& mesh, CountedTriangles meshed)
      : domain_(domain), mesh_(mesh), meshed_(meshed) {}

  /// One thread. Takes a look at all subfacets once.
  PoorReason named(const DomainReason& reason, std::uint32_t cell);

 private:
  std::array<std::uint32_t, 2> triangles_at_angle(const DomainReason& reason) const;
  GivenEntity name_of(EntityRef entity, std::uint32_t triangle);
  std::uint32_t given_facet(EntityId facet);
  std::uint32_t find_given_facet(EntityId facet) const;
  void find_subfacets();

  const Domain<D>& domain_;
  const OutputMesh<D>& mesh_;
  CountedTriangles meshed_;
  std::vector<std::uint32_t> subfacet_of_, given_of_;  ///< of each facet: its first subfacet; its name once it was asked for
};

extern template class GivenNames<2>;
extern template class GivenNames<3>;

}  // namespace pgdr
