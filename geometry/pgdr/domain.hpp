// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A checked and prepared `Plc<D>`: distinct points, maximal segments, facets as unions of triangles. Everything that
// refines a mesh speaks of the entities of a Domain. Immutable once made; any number of threads may read it.
//
// Definitions (3D). A polygon is the union of the triangles of one deterministic triangulation in its projection; its
// planarity defect is reported. A polygon with points off its plane by more than 1e-4 of its extent is several facets,
// one for each exactly planar part of this union. Facets that are coplanar, exactly or up to the tolerance, share an
// edge used by just these two, and have equal markers, are one facet. A segment is an edge that bounds a facet, is used
// by one or by more than two triangles, is explicit in the input (a segment, or an edge of a polygon: also one inside its
// facet), or lies between two facets. Diagonals inside one input polygon that is one facet are never segments, also where
// it is not exactly planar. A segment of the input from one point of a polygon facet to another, through the inside of
// the facet, is one of its segments.
//
// What lies within the tolerance meets (docs/inputs.md): points become one, by at most twice the tolerance; a point within it of
// an edge or of the inside of a facet lies on it, without moving; so does an edge along a facet. Decided once, as given.
//
// Pieces that meet where they have no corner in common are fitted to each other: a point inside a segment or an edge of a facet
// splits it, and the facets with it; a point inside a facet becomes a point of it; an edge or a segment that runs inside of a
// facet becomes one of its segments; facets that overlap in one plane are subdivided along each other's outlines, and what
// several have is the first one's. A point is added where edges cross inside of such a plane. A facet of one polygon all of whose
// points lie on a line is dropped, as it has no area and bounds nothing. What meets otherwise (see diagnosis.hpp) is not refused
// here.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

namespace detail {
class BentFacets;
}

/// A maximal segment, which the mesh has as a chain of subsegments.
struct DomainSegment {
  std::array<std::uint32_t, 2> points;    ///< indices into Domain::points, lexicographically smaller coordinates first
  int marker = 0;                         ///< of the first such segment of the input; 0 of an edge of facets alone
  bool explicit_in_input = false;         ///< one of Plc::segments, or a facet of one polygon of two corners
  std::uint32_t input = no_entity;        ///< index in Plc::segments of the first such segment; no_entity: none
  std::uint32_t input_facet = no_entity;  ///< in its place, index in Plc::facets where the first one is such a facet
};

/// What a segment, or a part of it, is in the input.
struct SegmentOrigin {
  std::uint32_t index;                                     ///< in Plc::segments, or in Plc::facets
  bool is_facet = false;                                   ///< a facet of one polygon of two corners
  auto operator<=>(const SegmentOrigin&) const = default;  ///< by index
};

/// Where a triangle of a facet comes from.
struct TriangleOrigin {
  std::uint32_t facet;    ///< index in Plc::facets
  bool reversed = false;  ///< its corners run against those of the facet's first polygon
  bool mixed = false;     ///< the facet is one of several in one plane that were triangulated anew, together
};

/// A maximal facet (3D), which the mesh has as a union of subfacets.
struct DomainFacet {
  int marker = 0;      ///< of its input facets, which all have it
  int axis = 2;        ///< the coordinate dropped in its projection: the largest component of its normal
  bool planar = true;  ///< all its points lie exactly in the plane of its first triangle
  /// Largest distance of one of its points from the plane of its first (largest) triangle; 0 if planar. Units of input.
  double planarity_defect = 0;
  std::uint32_t first_triangle = 0;  ///< of Domain::triangles(f), among those of all facets
  std::uint32_t triangle_count = 0;  ///< orient_projected positive each; the one of largest projected area is first
  std::uint32_t first_segment = 0;   ///< of Domain::facet_segments(f), among those of all facets
  std::uint32_t segment_count = 0;   ///< bounding and inner ones
  std::uint32_t first_point = 0;     ///< of Domain::facet_points(f), among those of all facets
  std::uint32_t point_count = 0;     ///< all, sorted by index
};

template <int D>
class Domain;
/// x projected to facet f: orthogonally to the plane of the defining triangle that contains x in the facet's
/// projection (nearest one if none does), in double-double, rounded once; exactly on it where axis-aligned.
Point<3> point_on_facet(const Domain<3>& domain, EntityId f, const Point<3>& x);

/// The input as the mesher reads it. One that was moved from is empty, without points and entities: `refine` refuses it
/// with a UsageError, and nothing else finds anything in it. About 200 bytes and 2 microseconds a triangle; made on the
/// threads of the caller's tbb::task_arena, the same for any number of them.
template <int D>
class Domain {
 public:
  /// Checks and prepares. What can be repaired without changing the geometry (exact duplicates of points, segments and polygon
  /// edges of no length, repeated segments and facets of the same triangles, -0, and what is said above) is, and is reported
  /// in `repairs()`, one entry a kind: `ids` has all of them (pairs: the dropped one, the kept one; a point and the ends
  /// of its edge, point_on_segment; a point and a facet, point_on_facet; the ends of an edge and a facet,
  /// entities_intersect; a flat facet, degenerate_facet), the message at most twenty; `code` is that of the error which
  /// it would have been.
  /// @throws InputError with ids, coordinates, and file and line if known, and all others among its diagnostics:
  ///   not_finite, index_out_of_range,
  ///   degenerate_facet (of none or several polygons: fewer than three distinct points, or all collinear; enclosing nothing),
  ///   self_crossing_facet (two polygon edges cross, or a vertex lies inside an edge, though in the projection alone),
  ///   seed_on_boundary (the hole of a facet lies on its polygons), no_volume. UsageError bad_option: arrays of another length.
  ///   CancelledError once `stop` is requested, from any thread: as soon as DiagnosisOptions::stop ends a diagnosis.
  explicit Domain(const Plc<D>& plc, std::stop_token stop = {});
  /// The same without the entities that cannot be: each is left out, and named in `refused`, as the exception that the
  /// constructor would have thrown. Empty if points are not finite or do not exist. For diagnosis only: if anything was
  /// refused, what is said of Domains here need not hold.
  /// @throws CancelledError
  static Domain without_invalid(const Plc<D>& plc, std::vector<Diagnostic>& refused, std::stop_token stop = {});

  std::span<const Point<D>> points() const { return points_; }  ///< distinct; views live as long as the Domain
  /// Domain point of each Plc point (exact duplicates, and those within the tolerance, share one). Distinct points keep
  /// the order of the input.
  std::span<const std::uint32_t> point_of_input() const { return point_of_input_; }
  /// First Plc point of each domain point. Those that were added stand behind all others, and count on from the number of Plc
  /// points: they are none of these.
  std::span<const std::uint32_t> input_of_point() const { return input_of_point_; }
  std::span<const int> point_markers() const { return point_markers_; }  ///< one a domain point, or empty
  /// points().size() times attributes_per_point(), one point after the other.
  std::span<const double> point_attributes() const { return point_attributes_; }
  /// How many attributes each point has.
  std::size_t attributes_per_point() const { return points_.empty() ? 0 : point_attributes_.size() / points_.size(); }
  std::span<const DomainSegment> segments() const { return segments_; }  ///< by EntityId
  std::span<const DomainFacet> facets() const { return facets_; }        ///< by EntityId; 2D: none
  /// What of the input runs along the whole of segment s: more than one where segments of the input repeat each other or
  /// overlap, none where s is an edge of facets alone. Those of Plc::segments first, ascending.
  std::span<const SegmentOrigin> segment_origins(EntityId s) const;
  /// Facets of the input that triangles stand for beside those of triangle_origins, since they repeat these or overlap them:
  /// (number of the triangle among those of all facets, index in Plc::facets), sorted.
  std::span<const std::array<std::uint32_t, 2>> further_origins() const { return further_origins_; }
  std::size_t input_segments() const { return input_segments_; }              ///< how many Plc::segments there were
  std::size_t input_facets() const { return input_facets_; }                  ///< how many Plc::facets there were
  std::span<const std::array<std::uint32_t, 3>> triangles(EntityId f) const;  ///< that define facet f, by domain points
  std::span<const TriangleOrigin> triangle_origins(EntityId f) const;         ///< of each of triangles(f)
  /// The triangles of facet f with a corner at this domain point, ascending; counted from the first triangle of all facets, so
  /// that f's first one is `first_triangle`.
  std::span<const std::uint32_t> triangles_at(EntityId f, std::uint32_t point) const;
  std::span<const EntityId> facet_segments(EntityId f) const;     ///< of facet f
  std::span<const std::uint32_t> facet_points(EntityId f) const;  ///< of facet f, inner points included
  /// 3D: have facets f and g a point in common?
  bool facets_touch(EntityId f, EntityId g) const;
  /// Facets that have segment s among theirs, ascending.
  std::span<const EntityId> facets_of_segment(EntityId s) const;
  std::span<const Point<D>> holes() const { return holes_; }           ///< Plc::holes
  std::span<const RegionSeed<D>> regions() const { return regions_; }  ///< Plc::regions

  const Names& names() const { return names_; }  ///< Plc::names

  std::uint32_t first_index() const { return first_index_; }  ///< Plc::first_index
  const PlcSource& source() const { return source_; }         ///< Plc::source

  double segment_magnitude(EntityId s) const;  ///< largest |coordinate| of its points: the yardstick of "k ulps"
  double facet_magnitude(EntityId f) const { return facet_magnitudes_[f]; }  ///< largest |coordinate| of its points
  /// A number near the coordinates of the facet's points on its axis: their differences from it are exact. 0 if there is none.
  double facet_level(EntityId f) const { return facet_levels_[f]; }

  double tolerance() const { return tolerance_; }  ///< within which things meet, in units of the coordinates; see Plc::tolerance
  double largest_move() const { return largest_move_; }  ///< farthest that a point of the input is from its Domain point
  const std::vector<Diagnostic>& repairs() const { return repairs_; }    ///< what was mended, one entry a kind
  const std::vector<Diagnostic>& warnings() const { return warnings_; }  ///< what was found, and taken as it is
  /// Known: no two of facets, segments and points meet outside of their common points and edges.
  bool nothing_meets() const { return nothing_meets_; }

 private:
  template <int>
  friend class DomainBuilder;
  friend Point<3> point_on_facet(const Domain<3>& domain, EntityId f, const Point<3>& x);
  Domain() = default;
  bool nothing_meets_ = false;
  std::vector<Point<D>> points_;
  std::vector<std::uint32_t> point_of_input_, input_of_point_;
  std::vector<int> point_markers_;
  std::vector<double> point_attributes_;
  std::vector<DomainSegment> segments_;
  std::vector<DomainFacet> facets_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> triangles_at_begin_, triangles_at_;
  std::vector<TriangleOrigin> triangle_origins_;
  std::vector<std::array<std::uint32_t, 2>> further_origins_;
  std::vector<std::uint32_t> segment_origins_begin_;
  std::vector<SegmentOrigin> segment_origins_;
  std::size_t input_segments_ = 0, input_facets_ = 0;
  std::vector<EntityId> facet_segments_;
  std::vector<std::uint32_t> facet_points_;
  std::vector<std::array<EntityId, 2>> touching_;  // sorted: of facets with more than few_points
  static constexpr std::size_t few_points = 32;    // to look for one after the other
  std::vector<double> facet_magnitudes_, facet_levels_;
  std::vector<std::uint32_t> facets_of_segment_begin_;
  std::vector<EntityId> facets_of_segment_;
  std::vector<Point<D>> holes_;
  std::vector<RegionSeed<D>> regions_;
  Names names_;
  std::uint32_t first_index_ = 0;
  PlcSource source_;
  double tolerance_ = 0, largest_move_ = 0;
  std::vector<Diagnostic> repairs_, warnings_;
  std::shared_ptr<const detail::BentFacets> bent_facets_;  // 3D; copies share it
};

/// The point P + t (Q - P) of segment s (P, Q its ends, in that order), evaluated in double-double and rounded once
/// (<= 1 ulp of the segment's magnitude off its line; exactly on it where the segment is axis-aligned). 0 < t < 1.
template <int D>
Point<D> point_on_segment(const Domain<D>& domain, EntityId s, double t);

/// The smallest angle, in degrees, between two entities that share an input vertex; 180 if they share none, are the
/// same, or one is part of the other (a segment of the facet), and for a vertex or the volume. Segments: between their
/// directions at the shared vertex. Two facets: their dihedral angles at common segments, each between the half-planes
/// there, and at common vertices that are on no common segment the smallest angle between a direction into the one and
/// a direction into the other; so for a segment and a facet. Not below 60 or 90 where it is exactly that. Takes time
/// proportional to their common segments and points and to the triangles there (microseconds each).
template <int D>
double entity_angle(const Domain<D>& domain, EntityRef a, EntityRef b);

}  // namespace pgdr
