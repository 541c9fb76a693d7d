// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large cells may be about a point, by how near the entities of an input are to each other: the local feature size, but for
// what grows with the distance from it. Where two entities without a common point are d apart, cells are as large as d, and from
// there on they grow by as much as they are away, if what is between is meshed: h(x) is the least of gap(y) + |x - y|, for y on
// entities. Three kinds of y are looked at: all points of the Domain, with their distances from others and from segments within
// the pieces that they are of; and the places nearest to x on a segment and on anything, with their distances from what these
// entities do not touch. Immutable once made, any thread.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "diagnose/meshed_space.hpp"
#include "diagnose/near_pieces.hpp"
#include "pgdr/estimate.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

template <int D>
class SizeFieldOfGaps {
 public:
  /// A piece, and where it is nearest to a point.
  struct Near {
    std::uint32_t piece = no_entity;  ///< no_entity: none is as near as asked for
    double distance = std::numeric_limits<double>::infinity();
    Point<D> place;
  };

  SizeFieldOfGaps(const Domain<D>& domain, const EstimateOptions<D>& options, const Bulk& bulk);

  const NearPieces<D>& pieces() const { return pieces_; }
  const MeshedSpace<D>& space() const { return space_; }
  const BoxTree<D>& tree() const { return tree_; }  ///< of the pieces
  /// A place on an entity: how far it is from x, and from what the entity does not touch.
  struct Narrow {
    double distance = std::numeric_limits<double>::infinity(), gap = std::numeric_limits<double>::infinity();
    Point<D> place;
    double size() const { return distance + gap; }
  };
  /// What is about x, in unit scale (NearPieces). Places that would not make h less are left out.
  struct Look {
    double h;
    Narrow nearest, on_segment;  ///< 2D: the latter is never there
  };
  Look look(const Point<D>& x) const;
  /// The piece nearest to x, if it is nearer than `most`.
  Near nearest(const Point<D>& x, double most) const;
  /// The same of pieces whose entities have no point in common with that of a piece, on which x is, where what is between is
  /// meshed.
  Near nearest_disjoint(const Point<D>& x, std::uint32_t from, double most) const;

 private:
  template <class MayFace>
  Near nearest_disjoint(const Point<D>& x, const typename NearPieces<D>::Piece& own, double most, const MayFace& may_face) const;
  std::vector<double> sizes_at_points(const std::optional<Gap<D>>& narrowest, const Bulk& bulk) const;
  double from_points(const Point<D>& x) const;
  Near nearest_segment(const Point<D>& x, double most) const requires(D == 3);
  std::vector<double> facets_of_pieces(double sign, const Bulk& bulk) const;

  NearPieces<D> pieces_;
  MeshedSpace<D> space_;
  BoxTree<D> tree_, points_tree_, segments_tree_;
  std::vector<double> sizes_, least_size_below_;
  std::vector<double> least_facet_below_, greatest_facet_below_;  ///< the latter with its sign changed
};

extern template class SizeFieldOfGaps<2>;
extern template class SizeFieldOfGaps<3>;

}  // namespace pgdr::detail
