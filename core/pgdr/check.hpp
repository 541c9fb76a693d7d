// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker: decides from the input and the finished mesh alone whether the mesh is sound, Delaunay, conforming and within its
// bounds.
//
// It shares with the mesher what lies below both: the readers of files, the predicates, the planar triangulation of a polygon,
// the tests of bounds, and what rounding may explain. It shares nothing of how meshes are made, nor of what is joined or repaired
// in an input. Exact arithmetic wherever a verdict depends on a sign; distances from what was given are compared in doubles, with
// bounds of their errors. Any thread; no state.
//
// Against the input as given (CheckOptions::input), with T the tolerance and u two ulps of its largest coordinate:
//
// * Each given point (CheckOptions::required_points: each of these) is a vertex; or, if another given point is within 2 T, a
// vertex is within 2 T of it.
// * Each subfacet (2D: subsegment) lies within T + u of given facets (segments) of its marker, all of it. Instead of T, 2 T at
//   facets whose points have moved by so much, and at those that may be one facet with others, since their points are within T of
//   one plane: that facet, and what was given, are both within T of it. A facet whose points are not in one plane is only known
//   up to the thickness b of the layer that they lie in, since its polygons can be triangulated in several ways: T + u + b.
// * Each given facet is covered by subfacets within that distance of it, of any marker, as they lie on given facets of that
//   marker. So are given segments by subsegments. Areas are not summed up: what is not covered is computed. It is not asked of
//   triangles that are not ten times as high as T + u, nor of segments as short.
// * What was given and is not in the mesh lies outside of all cells, and bounds no volume that is to be meshed.
// * Cells fill the volumes that are to be meshed, exactly, as far as the walls of the mesh bound them; holes and the outside
//   are empty. Labels are those of the seeds; numbers (numbers_volumes) are in order, but for volumes whose least segments
//   begin at one point, which may be in any order.
// * The measure of a volume whose given facets close exactly differs from theirs by no more than (area of its boundary) (T + u)
//   + (perimeter of its subfacets) (T + u)^2, with what was said above in the place of T + u.
// * A reason names segments and facets of the input (GivenEntity). It holds if these meet at a small angle, as much as it says,
//   and one of them is near the cell. Angles are those of points that were given, exactly, or of points of the mesh on a facet,
//   up to what these may be off it.
//
// With CheckOptions::surface_tolerance, E, the surface of the mesh is another one, and points 2, 3, 4 and the last but one give
// way to these, in which facets are joined within T, what no volume to be meshed touches is left out, and u is as above (and b,
// of facets whose points are not in one plane, is added to it):
//
// * Each subfacet is within E + u of given facets of its marker, and each given facet within E + u of subfacets of its marker.
// * The same of subsegments and given segments with a marker; of edges with one subfacet, with three or more, or with subfacets
//   of two markers, and such edges of the given facets, kind by kind. Creases and given segments are within E + u of subsegments.
// * Both surfaces have as many components and open loops, the same Euler characteristic and handles; marker by marker, too.
// * Vertices and centroids of cells that are deeper than E in their volume are in one given volume, which is to be meshed, and
//   not in that of others; each given volume to be meshed that is deeper than 2 E somewhere has one. Seeds are in the same.
// * What a given volume and that of the mesh measure differs by no more than what lies within E of the given facets about it.
// * Given points are vertices if they are ends of segments, have a marker other than 0, or are of no facet.
// * Reasons name what the mesh has: segments by their ends, facets by a place on them.
//
// With the input at hand the verdict is complete. Positively oriented cells cover the volume that they are to fill exactly once,
// if their faces match, and if their boundary is, triangle by triangle, a triangulation of the boundary of that volume. Without
// the input, cells that overlap are found where they share a vertex, not where two far boundaries cross.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/poor_reason.hpp"
#include "pgdr/region_mode.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr PGDR_API {

/// What a mesh is checked for. A plain value; what it points to must outlive the call. Lengths are in the units of the
/// coordinates. By default a mesh is checked for what any mesh must be: sound cells whose faces match. Each option asks for more.
///
/// @code
/// const auto result = pgdr::refine(plc, refine_options);
/// pgdr::CheckOptions<3> options;
/// options.input = &plc;                                                   // as it was given, before any repair
/// options.radius_edge_bound = refine_options.radius_edge_bound;
/// options.size = refine_options.size;
/// options.largest_cosine = result.optimization.claimed_cosine;            // the angle that the optimiser worked for
/// options.delaunay = result.delaunay;
/// options.reasons = &result.reasons;                                      // each is verified
/// const pgdr::CheckReport report = pgdr::check(result.mesh, options);     // report.exit_code() <= 1: nothing is wrong
/// @endcode
template <int D>
struct CheckOptions {
  // ---- against what was given ----------------------------------------------------------------------------------------

  /// The input as given: the mesh is certified against it, and nothing that was made of it. DEFAULT: null, neither conformity nor
  /// regions are checked, and boundaries that cross far from common vertices are not found.
  const Plc<D>* input = nullptr;

  /// The tolerance that the mesh was made with, an absolute length (Domain::tolerance). DEFAULT: none, which is that of a Plc
  /// without one. REQUIRES: not negative. Without `input` it has no effect.
  std::optional<double> tolerance;

  /// What of the input is to be meshed, and how it is to be labelled: RefineOptions::regions. DEFAULT: every volume but those of
  /// hole seeds. Without `input` it has no effect.
  RegionMode regions = RegionMode::seeds;

  /// Was the boundary to be kept (RefineOptions::keep_boundary)? Then no vertex on a kept segment or facet is none of the input,
  /// and each given triangle that no other given point lies on is one subfacet (2D: segments, one subsegment). DEFAULT: false.
  /// Without `input` it has no effect.
  bool keep_boundary = false;

  /// RefineOptions::kept_markers. DEFAULT: none, everything was to be kept.
  std::vector<int> kept_markers;

  /// 3D: markers of sides that correspond (periodic.hpp), whose subfacets are kept though they were not given: a reason
  /// kept_boundary may name a facet with one of these. Whether they do correspond is for periodic_pairs() to say. DEFAULT: none.
  std::vector<int> kept_sides;

  /// 3D: E, an absolute length: the mesh is of another surface, and certified to be within E of the given one, both ways, as is
  /// said at the head of this file. DEFAULT: none, it is of the given one. REQUIRES: above 0, finite; some hundred ulps of the
  /// largest coordinate at least, or rounding leaves pieces undecided, which are findings. Without `input` it has no effect. 2D:
  /// REQUIRES none.
  std::optional<double> surface_tolerance;

  /// Edges of the given facets at which normals differ by more than this are creases, which have subsegments within E. DEFAULT:
  /// 40 degrees. REQUIRES: 0 to 180, which is none. Without `surface_tolerance` it has no effect.
  double feature_angle = 40;

  /// Which of the given points must be vertices, one flag a point. Others are certified as parts of the segments and facets that
  /// have them, which are covered; where nothing has them they may be missing; and their markers do not count. For a mesh whose
  /// input is another mesh (remesh_input.hpp), and with whole facets. DEFAULT: none, which is all of them. Without `input` it has
  /// no effect.
  std::optional<std::vector<std::uint8_t>> required_points;

  // ---- bounds on the cells: what is over one needs a reason ----------------------------------------------------------

  /// Upper bound on circumradius over shortest edge, of each cell. DEFAULT: infinity, none. REQUIRES: above 0.
  double radius_edge_bound = std::numeric_limits<double>::infinity();

  /// Bound on the circumradius (3D) or the area (2D) of a cell, at its centroid. A number or a function, which is called by the
  /// calling thread. DEFAULT: none. REQUIRES: above 0.
  SizingField<D> size;

  /// Further such bounds on the cells with a label. DEFAULT: none. REQUIRES: sizes above 0, and labels that cells have, or 0.
  RegionSizes<D> region_sizes;

  /// Bound on the volume (2D: area) of each cell. DEFAULT: infinity, none. REQUIRES: above 0.
  double max_measure = std::numeric_limits<double>::infinity();

  /// Do the sizes that region seeds of the input have bind? Not where the refinement was left out, or ended before it was done.
  /// DEFAULT: true. Without `input` it has no effect.
  bool seed_sizes = true;

  /// 3D: bound on dihedral angles, as the cosine of the smallest one that is allowed, rounded to a double
  /// (OptimizationStatistics::claimed_cosine): so the verdict is exact. DEFAULT: 1, none. REQUIRES: 0 to 1. 2D: no effect.
  double largest_cosine = 1;

  /// Why cells are over a bound, and faces not locally Delaunay. Each reason is verified. DEFAULT: null, there are none.
  /// REQUIRES: those of this mesh, whose cells count from 0.
  const std::vector<PoorReason>* reasons = nullptr;

  // ---- locally Delaunay ----------------------------------------------------------------------------------------------

  /// Must faces be locally Delaunay, but for what rounding or a refused split (in `reasons`) explains? DEFAULT: false.
  bool delaunay = false;

  /// 2D: must it be conforming Delaunay (RefineOptions::conforming_delaunay)? Then faces must be locally Delaunay as with
  /// `delaunay`, across subsegments, too, and no edge of a single triangle has its third vertex inside its diametral circle. So
  /// no vertex that is not beyond the outside or a void lies inside the circumcircle of any triangle, and all circumcentres lie
  /// in the domain. Rounding explains what it does for `delaunay`; no reason, and nothing that is said to be left, does at
  /// subsegments. DEFAULT: false. REQUIRES: 2D.
  bool conforming_delaunay = false;

  /// So many faces are said to be left that are not locally Delaunay, other than by rounding (NotDelaunay::other). As long as
  /// there are no more, those beside no refused split are `not_delaunay_unexplained`, and else findings. DEFAULT: 0. Without
  /// `delaunay` it has no effect.
  std::uint64_t not_delaunay_left = 0;

  /// By how many ulps of the mesh's largest coordinate a vertex on a slanted entity may be off that: a face that is locally
  /// Delaunay if its vertices move by so much counts as rounding. One ulp is 2^-52 times that coordinate. DEFAULT: 2. REQUIRES:
  /// not negative. Without `delaunay` it has no effect.
  int conformity_ulps = 2;

  // ---- what it tells, and when it ends -------------------------------------------------------------------------------

  /// So many findings of one kind at most have words; all are counted. DEFAULT: 20.
  std::size_t max_listed = 20;

  /// Ends the check by a CancelledError, from any thread. DEFAULT: nothing can.
  std::stop_token stop = {};
};

/// Something that makes the check fail.
struct CheckFinding {
  /// Each is counted by itself.
  enum class Kind {
    not_finite,              ///< a coordinate is infinite or not a number
    bad_index,               ///< a vertex that does not exist, or labels that are not one a cell (marker: a point)
    repeated_vertex,         ///< a cell or constraint with the same vertex twice
    duplicate_point,         ///< two points with the same coordinates
    unreferenced_point,      ///< a point that is not of the input and lies in no cell
    inverted_cell,           ///< orientation not positive
    bad_link,                ///< a face shared wrongly, or a hull face that is no constraint
    overlapping,             ///< cells round a vertex that cover some direction twice, or not at all
    not_delaunay,            ///< beyond what rounding or a refused split explains, and more than are said to be left
    missing_input_point,     ///< an input point that is no vertex of a cell
    segment_not_conforming,  ///< no chain of subsegments, or one off its line
    facet_not_conforming,    ///< not the union of its subfacets, or a vertex off its plane
    wrong_marker,            ///< of an input point, a subsegment or a subfacet
    wrong_name,              ///< of a marker or a label that has another one in the input, but for what a format cannot hold
    stray_constraint,        ///< a subsegment or subfacet that no entity owns or no cell has
    wrong_region,            ///< label not constant in a volume, or not that of its seed, or not the automatic one
    wrong_volume,            ///< a volume without cells, only partly filled, or of another measure
    hole_filled,             ///< cells outside the domain or in a hole
    over_radius_edge,        ///< without a reason
    over_size,               ///< without a reason
    bad_reason,              ///< a reason that is not true
    off_surface,             ///< with a surface tolerance: a subfacet or subsegment farther than that from what was given
    surface_not_covered,     ///< with one: something given, to which the mesh has nothing as near
    other_topology,          ///< with one: the surface of the mesh hangs together otherwise than the given one
    boundary_not_kept,  ///< where it was to be kept: a point on it that was not given, or a given triangle that is no subfacet
  };
  static constexpr std::size_t kinds = static_cast<std::size_t>(Kind::boundary_not_kept) + 1;  ///< so many
  Kind kind;                                                                                   ///< what is wrong
  std::string message;            ///< one sentence; numbers of points, cells and entities count from 0
  std::vector<std::int64_t> ids;  ///< the cells, vertices or entities of the message, in its order
};
/// The stable snake_case word of the JSON report.
std::string_view name(CheckFinding::Kind kind);

/// The verdict, and what it rests on.
struct CheckReport {
  std::uint64_t not_delaunay_rounding = 0;     ///< local violations that moving slanted points by conformity_ulps cancels
  std::uint64_t not_delaunay_refused = 0;      ///< other violations, beside an entity whose split was refused (in reasons)
  std::uint64_t not_delaunay_unexplained = 0;  ///< other ones, which are said to be left
  std::uint64_t over_radius_edge = 0;          ///< cells over the radius-edge bound
  std::uint64_t over_size = 0;                 ///< cells over a bound of size, volume or area
  std::uint64_t below_dihedral = 0;            ///< cells with a dihedral angle below the bound
  std::uint64_t explained = 0;                 ///< cells over a bound with a reason that holds
  /// Cells over a bound without an excuse: those that the reasons admit, and all others below the bound on dihedral angles.
  std::uint64_t unexplained = 0;
  /// With a surface tolerance: volumes of the mesh that are nowhere deeper than that, so that nothing of the given ones is surely
  /// in them, and given ones to be meshed that are nowhere deeper than twice that and have no volume of the mesh.
  std::uint64_t undecided_volumes = 0;
  std::vector<CheckFinding> findings;                              ///< what makes the check fail, at most max_listed a kind
  std::uint64_t finding_count = 0;                                 ///< all of them
  std::array<std::uint64_t, CheckFinding::kinds> count_of_kind{};  ///< findings, by kind
  /// Findings of one kind.
  std::uint64_t count(CheckFinding::Kind kind) const { return count_of_kind[static_cast<std::size_t>(kind)]; }
  /// 0: sound, conforming and within all bounds; 1: cells are over a bound, but explained, or `unexplained`, or faces are
  /// `not_delaunay_unexplained`, and nothing else is wrong; 6: anything else. Faces that are not locally Delaunay by rounding or
  /// beside a refused split change nothing.
  int exit_code() const;
};

/// Unconstrained faces with the vertex beyond them strictly inside the circumsphere of the cell on their other side.
struct NotDelaunay {
  std::uint64_t rounding = 0;  ///< those that moving slanted points by CheckOptions::conformity_ulps cancels
  std::uint64_t other = 0;     ///< all else
};
/// Counts them without the input, so that a point on any slanted entity may be off by ulps of the largest coordinate.
/// Not `everywhere`: only beside such points, which is enough where `RefineResult::violations_seen` is false.
/// @pre a sound mesh, e.g. one that `refine` made
template <int D>
NotDelaunay count_not_delaunay(const OutputMesh<D>& mesh, bool everywhere = true);

/// A cell that is not Delaunay, and the vertex that says so.
struct NotDelaunayCell {
  std::uint32_t cell;    ///< its row
  std::uint32_t vertex;  ///< the row of one that lies strictly inside its circumsphere, of its neighbour across a face
};
/// The cells with a vertex strictly inside their circumsphere across a face that is no subfacet (2D: subsegment), exactly, each
/// once, in their order. What lies beyond subfacets does not count, as in constrained Delaunay meshes. By the Delaunay lemma of
/// these the mesh is constrained Delaunay if and only if there are none; if there are some, others may have vertices that are
/// farther away inside. Linear time, on the calling thread; any thread.
/// @pre a sound mesh, e.g. one that `refine` made
template <int D>
std::vector<NotDelaunayCell> cells_not_delaunay(const OutputMesh<D>& mesh);

/// Runs all checks for which `options` has the data. Bad indices and coordinates that are not finite end it early.
/// About 5 microseconds a cell, on the calling thread.
/// @throws UsageError bad_size if a size function returns a value that is not positive, bad_option if no cell has the label
///   of a region size (but 0), or for conforming_delaunay in 3D; InputError index_out_of_range, not_finite of the input;
///   CancelledError some hundredths of a second after CheckOptions::stop is requested, from any thread; ResourceError.
template <int D>
CheckReport check(const OutputMesh<D>& mesh, const CheckOptions<D>& options);

}  // namespace pgdr
