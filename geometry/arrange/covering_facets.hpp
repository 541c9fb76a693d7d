// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which facets of a Plc cover a triangle of its Domain, and which way round. Where facets overlap, or were triangulated anew
// together, a Domain names all that are of the layers over a triangle; of the facets of one layer one alone has the triangle's
// middle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/domain.hpp"

namespace pgdr::detail {

/// A facet of a Plc over a triangle.
struct CoveringFacet {
  std::uint32_t facet;    ///< index in Plc::facets
  bool reversed = false;  ///< the triangle's corners run against those of the facet's first polygon
};

class CoveringFacets {
 public:
  CoveringFacets(const Plc<3>& plc, const Domain<3>& domain) : plc_(plc), domain_(domain) {}

  /// Those over triangle k of facet f of the Domain, the one whose marker it has first.
  std::vector<CoveringFacet> of(EntityId f, std::uint32_t k) const;
  /// All that may be, the one of TriangleOrigin first.
  std::vector<std::uint32_t> candidates(EntityId f, std::uint32_t k) const;

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  std::uint32_t at(std::uint32_t v) const { return domain_.point_of_input()[v]; }
  bool has_middle(std::span<const std::uint32_t> polygon, const Triangle& t, int axis) const;
  bool has_middle(const Plc<3>::Facet& facet, const Triangle& t, int axis) const;
  bool is_reversed(std::span<const std::uint32_t> polygon, int axis) const;

  const Plc<3>& plc_;
  const Domain<3>& domain_;
};

}  // namespace pgdr::detail
