// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what meets, or comes within the tolerance of what it does not belong to: points near edges and facets, and edges that run
// along facets. One pass over the pairs of pieces whose boxes meet tells whether there is anything at all, which of most inputs
// there is not; the rest looks at the pairs that it found. Used by one thread; its loops run in parallel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "input/triangle_shapes.hpp"
#include "join/build_input.hpp"
#include "join/facet_triangulator.hpp"
#include "join/near_contacts.hpp"
#include "space/contact.hpp"

namespace pgdr::detail {

template <int D>
class NearSearch {
 public:
  /// `own`: through which points edges of facets go already. Nearness is that to the edges as given, and not to their pieces.
  explicit NearSearch(const BuildInput<D>& in, const NearContacts& own = {});

  /// Within which, times BuildInput::scale; 0: only what meets exactly is found.
  double width() const { return width_; }

  /// Finds the pairs of pieces (triangles, edges of no triangle, points of neither) that meet or come near where they have no
  /// corner in common, of which all else here speaks; true if there are any, or a triangle with a corner near its edge opposite.
  /// The facets of triangles are indexed then.
  bool find_pairs(FacetTriangles& faces, std::span<const OwnedEdge> segment_edges, std::span<const FlatFacet> flat);

  /// Points near edges, those that these go through already among them, and near the inside of facets.
  NearContacts contacts() const;
  /// Edges, of no common point and not in one plane, that pass each other within the width; none in 2D.
  std::vector<std::array<PlanarEdge, 2>> passing_edges() const;

 private:
  using Pair = std::array<std::uint32_t, 2>;  // of pieces

  bool is_triangle(std::uint32_t piece) const { return piece < faces_->triangles.size(); }
  bool have_one_facet(std::uint32_t i, std::uint32_t j) const {
    return is_triangle(j) && is_triangle(i) && faces_->facet_of[i] == faces_->facet_of[j];
  }
  bool come_near(std::uint32_t i, std::uint32_t j) const;
  bool is_near_corner(std::uint32_t i, std::uint32_t j) const;
  bool have_passing_edges(std::uint32_t i, std::uint32_t j) const;
  bool is_clear_of_plane(std::uint32_t i, std::uint32_t j) const;
  /// The edges of a piece; memory of its own would cost more than all else.
  class PieceEdges {
   public:
    void add(std::uint32_t a, std::uint32_t b) { edges_[count_++] = {a, b}; }
    const PlanarEdge* begin() const { return edges_.data(); }
    const PlanarEdge* end() const { return edges_.data() + count_; }

   private:
    std::array<PlanarEdge, 3> edges_;
    std::size_t count_ = 0;
  };
  PieceEdges edges_of(std::uint32_t piece, bool constrained) const;
  template <class Test>
  bool any_given(const PlanarEdge& edge, const Test& test) const;
  std::array<Point<D>, 3> triangle(std::uint32_t piece) const;
  void add_points_on_edges(std::uint32_t i, std::uint32_t j, std::vector<NearPoint>& found) const;
  using PointsInFacets = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  PointsInFacets points_in_facets(const NearContacts& on_edges) const;

  const BuildInput<D>& in_;
  double width_;
  std::vector<Point<D>> scaled_;
  std::vector<NearPoint> own_;                                     // the points that edges go through already
  std::vector<std::pair<std::uint64_t, std::uint64_t>> given_of_;  // the keys of pieces of edges, and of these; sorted
  const FacetTriangles* faces_ = nullptr;
  std::vector<Piece> pieces_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> closed_;  // triangles with a corner near the edge opposite
};

}  // namespace pgdr::detail
