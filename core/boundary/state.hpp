// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The state of boundary recovery in 3D: the chains of subsegments and the triangulated facets. Private to this room.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "boundary/present_simplices.hpp"
#include "boundary/recovery.hpp"
#include "boundary/square_flips.hpp"
#include "boundary/wanted_simplices.hpp"
#include "mesh/ids.hpp"
#include "rule/shells.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// A piece of a segment between two neighbours in its chain.
struct Subsegment {
  EntityId segment;
  VertexId a, b;
  double t;  ///< parameter of a on the segment
};

using WantedEdges = WantedSimplices<2, EntityId>;  ///< with segments
using WantedFaces = WantedSimplices<3, EntityId>;  ///< with facets

/// The trend of how many simplices were missing, round by round.
class MissingTrend {
 public:
  void note(std::size_t missing) {
    most_ = std::max(most_, missing);
    last_ = missing;
    ++rounds_;
  }
  std::uint64_t rounds() const { return rounds_; }
  bool is_falling() const { return last_ < most_; }  ///< were more missing before?

 private:
  std::size_t most_ = 0, last_ = 0;
  std::uint64_t rounds_ = 0;
};

/// 3D: the subsegments of every segment, and where to split them.
class SegmentChains {
 public:
  /// A vertex of a chain.
  struct Link {
    VertexId vertex;
    double t;                   ///< parameter on the segment
    std::uint32_t round = 0;    ///< in which it was made
    CellId seen = never_asked;  ///< a cell that has the edge to it from the vertex before
  };

  /// All must outlive it. `squares`: what flips are to make is neither missing nor split.
  SegmentChains(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SquareFlips& squares, const Bulk& bulk);

  /// Segments with subsegments that are no edges of the mesh.
  std::vector<EntityId> missing_segments();
  /// Splits every subsegment that is no edge of the mesh, until none is missing. False if `stop` says so.
  template <class Stop>
  bool recover(const Stop& stop) {
    trend_ = {};
    for (bool again = true; again;) {
      again = false;
      const std::vector<Subsegment> list = missing();
      trend_.note(list.size());
      for (const Subsegment& s : list) {
        if (stop()) return false;
        if (squares_->has_segment(s.segment)) continue;
        again = split(s) != no_vertex || again;
      }
    }
    return true;
  }
  /// Splits the subsegment, if it is still one and no vertex is nearer to the point than `least`: the new vertex, or no_vertex.
  VertexId split(const Subsegment& s, double least = 0);

  const std::vector<Link>& chain(EntityId segment) const { return chains_[segment]; }
  /// Was it made since the last call of take_changed()?
  bool is_new(const Link& link) const { return link.round == round_; }
  /// Segments whose chain has changed since the last call.
  std::vector<EntityId> take_changed();
  std::uint64_t points() const { return points_; }
  const MissingTrend& trend() const { return trend_; }  ///< of the last recover()
  /// All subsegments, with their segments.
  WantedEdges wanted() const;
  /// @throws InputError boundary_not_recovered: an edge is one of two segments
  void require_distinct(const WantedEdges& wanted) const;

 private:
  Diagnostic not_resolved(EntityId segment, bool is_its_end, Home home, const Point3& x) const;
  std::vector<Subsegment> missing();
  std::size_t position(const Subsegment& s) const;
  // boundary/twins.cpp
  void find_companions();
  template <class Visit>
  void for_each_along(EntityId s, EntityId companion, double begin, double end, const Visit& visit) const;
  const std::vector<Link>& input_beside(EntityId s);
  std::pair<double, std::vector<VertexId>> split_place(EntityId s, double begin, double end);

  void add(EntityId segment, std::size_t position, VertexId v, double t);

  Mesh<3>* mesh_;
  Delaunay<3>* delaunay_;
  const Domain<3>* domain_;
  SquareFlips* squares_;
  const Bulk* bulk_;
  std::vector<std::vector<Link>> chains_;
  Shells<3> shells_;
  std::vector<std::vector<EntityId>> companions_;                 ///< of each segment, those that run along it from a common end
  std::unordered_map<EntityId, std::vector<Link>> input_beside_;  ///< of segments that were split
  std::unique_ptr<BoxTree<3>> points_tree_;                       ///< of the input points; made where a segment is split
  PresentSimplices<2> edges_;
  std::vector<EntityId> look_again_;  ///< segments with subsegments that are new, or were missing
  std::vector<EntityId> changed_;
  std::uint32_t round_ = 1;
  std::uint64_t points_ = 0;
  MissingTrend trend_;
};

/// The triangulation of every facet in its plane. What is missing in a round is found, and its splits are planned, for all facets
/// side by side; the points go in one after the other.
class FacetPatches {
 public:
  FacetPatches(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SegmentChains& chains, SquareFlips& squares,
               const Bulk& bulk);

  /// Puts points where triangles are missing, one round. False if none was missing. Ends early if `stop` says so.
  bool recover_once(const std::function<bool()>& stop);
  /// Splits triangles of a radius-edge ratio above the bound, one round, in facets without sharp angles, where no edge below
  /// `min_edge` comes of it. False if none was split. @pre none is missing
  bool split_poor_triangles(double bound, double min_edge, const std::function<bool()>& stop);
  std::uint64_t points() const { return points_; }
  const MissingTrend& trend() const { return trend_; }
  /// All triangles, with their facets.
  WantedFaces wanted() const;
  /// @throws InputError boundary_not_recovered: a triangle is one of two facets
  void require_distinct(const WantedFaces& wanted) const;
  void require_edges_inside_one() const;
  std::size_t inner_points(EntityId facet) const { return inner_points_[facet].size(); }  ///< Steiner points inside the facet

 private:
  using Triangle = std::array<VertexId, 3>;
  bool triangulate_changed(const std::function<bool()>& stop);
  /// An edge that is no edge of a plane graph: two vertices; none, if all is well.
  using Crossing = std::optional<std::array<VertexId, 2>>;
  Crossing triangulate(EntityId facet);
  template <class Fill>
  void replace_triangles(EntityId facet, const Fill& fill);
  struct Candidate {
    Ball<3> ball;
    Triangle triangle;
    double least;  ///< how near its point may be to others
  };
  class SplitPlan;
  std::vector<SplitPlan> plan_splits(std::span<const EntityId> facets,
                                     const std::function<std::vector<Candidate>(EntityId)>& candidates_of) const;
  bool split_triangles(SplitPlan& plan, const std::function<bool()>& stop);
  bool may_split(const Subsegment& s) const;
  std::vector<Candidate> poor_triangles(EntityId facet, double bound, double min_edge) const;
  void find_calm_facets();
  void find_fragile();
  Point3 centroid_of(const Triangle& t) const;
  VertexId insert_inside(EntityId facet, const Candidate& c, const Point3& x);
  void add_inner_point(EntityId facet, VertexId v);
  std::vector<Subsegment> subsegments(EntityId facet) const;
  std::vector<EntityId> find_present();

  Mesh<3>* mesh_;
  Delaunay<3>* delaunay_;
  const Domain<3>* domain_;
  SegmentChains* chains_;
  SquareFlips* squares_;
  const Bulk* bulk_;
  std::vector<std::vector<Triangle>> triangles_;
  std::vector<std::vector<CellId>> seen_;            ///< of each triangle, a cell that has it
  std::vector<std::vector<VertexId>> inner_points_;  ///< Steiner points inside each facet
  PresentSimplices<3> faces_;
  std::vector<EntityId> look_again_;              ///< facets that were triangulated anew, or had triangles missing
  std::vector<EntityId> changed_;                 ///< to be triangulated anew
  std::vector<std::uint8_t> is_calm_;             ///< is a facet one whose triangles are split for their shape?
  std::vector<std::array<VertexId, 2>> fragile_;  ///< sorted: edges at triangles so flat that rounding may turn them over
  std::uint64_t points_ = 0;
  MissingTrend trend_;
};

/// The segments of the facet cross or touch in its projection, at these vertices.
InputError not_a_plane_graph(const Domain<3>& domain, EntityId f, const Mesh<3>& mesh, std::span<const VertexId> at);

}  // namespace pgdr::detail
