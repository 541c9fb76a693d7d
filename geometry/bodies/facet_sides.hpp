// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which facets of a body look the other way than their neighbours. Neighbours are two facets that are alone at an edge.
#pragma once

#include <cstdint>
#include <vector>

#include "pgdr/arrangement.hpp"
#include "pgdr/plc.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

class FacetSides {
 public:
  FacetSides(const Plc<3>& plc, const Arrangement& pieces) : plc_(plc), pieces_(pieces) {}

  /// A facet of a body covers a piece.
  void add(std::uint32_t piece, std::uint32_t facet, std::uint32_t body, bool reversed);
  /// Facets that have to be turned over, so that all that hang together by neighbours look to one side: the fewer ones; of
  /// equally many those without the facet of least corners. Ascending. @throws InputError not_orientable
  std::vector<std::uint32_t> minority(const Bulk& bulk);

 private:
  struct AtEdge {
    std::uint32_t body, a, b, facet;
    bool forward;
    friend auto operator<=>(const AtEdge&, const AtEdge&) = default;
  };
  std::uint32_t find(std::uint32_t facet, bool& differs);
  void unite(const AtEdge& x, const AtEdge& y);
  [[noreturn]] void fail(const AtEdge& x, const AtEdge& y) const;
  bool has_lesser_corners(std::uint32_t f, std::uint32_t g) const;

  const Plc<3>& plc_;
  const Arrangement& pieces_;
  std::vector<AtEdge> edges_;
  struct Link {
    std::uint32_t up;
    bool differs;  ///< looks the other way than `up`
  };
  std::vector<Link> links_;  ///< of facets
};

}  // namespace pgdr::detail
