// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which facets of an input are left as they are, and what is left of others, once pieces are dropped. A facet is left as it is if
// it is just its pieces, all of these are left, and nothing else has an edge inside of it: where facets were merged in one plane,
// or triangulated anew, a piece may lie across several; where facets cross, they have edges inside of each other. Immutable once
// made.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bodies/region_groups.hpp"
#include "pgdr/arrangement.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

class KeptFacets {
 public:
  /// All must outlive this. `are_cut`: facets cross, so that they are not what they were even where nothing is dropped.
  KeptFacets(const Plc<3>& plc, const Arrangement& pieces, const RegionGroups& groups, bool are_cut);

  std::size_t count() const { return from_.size(); }
  std::uint32_t facet(std::size_t i) const { return from_[i].facet; }  ///< of the input, that the i-th one comes from
  Plc<3>::Facet make(std::size_t i) const;                             ///< by the points of the arrangement

 private:
  struct From {
    std::uint32_t facet, piece;  ///< no_entity: the whole facet
  };
  using Edge = std::array<std::uint32_t, 2>;
  std::vector<Edge> edges_of(std::span<const std::uint32_t> pieces) const;
  bool is_itself(std::uint32_t facet, std::span<const std::uint32_t> its_pieces) const;
  bool is_triangle(const Plc<3>::Facet& facet, std::uint32_t piece) const;
  bool is_on_outline(const Plc<3>::Facet& facet, std::uint32_t v, std::uint32_t w) const;
  bool is_on_edge(std::uint32_t v, std::uint32_t a, std::uint32_t b) const;

  const Plc<3>& plc_;
  const Arrangement& pieces_;
  std::vector<Edge> edges_;  ///< of all pieces, sorted, as often as pieces have them; empty where nothing changes
  std::vector<From> from_;
};

}  // namespace pgdr::detail
