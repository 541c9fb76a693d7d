// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a Domain of a Plc, in this order: points (finite, merged), indices, facets to triangles, repeated facets,
// points and edges that lie on what they do not belong to, coplanar groups, segments, incidences. Each step is in a file of
// its own, domain_<step>.cpp. Everything is sorting and hashing: n log n in the size of the input, but for constraint edges
// of a facet that cross many triangles.
// Used by one thread, once; long loops run in its task arena, too.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pgdr/domain.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"
#include "space/stop_check.hpp"

namespace pgdr {
namespace detail {

/// "(1, 2.5, -3)", shortest digits that read back to the same doubles.
template <int D>
std::string to_text(const Point<D>& p);

/// `p` for a diagnostic.
template <int D>
std::array<double, 3> in_space(const Point<D>& p) {
  if constexpr (D == 3) return p.x;
  else return {p[0], p[1], 0};
}

/// Axes in the order of the size of this normal's components.
std::array<int, 3> axes_by_size(const std::array<double, 3>& normal);
/// (b - a) x (c - a), in doubles, of the points times `scale`.
std::array<double, 3> triangle_normal(const Point3& a, const Point3& b, const Point3& c, double scale);
/// Distance of p from the plane of abc.
double plane_distance(const Point3& a, const Point3& b, const Point3& c, const Point3& p);

/// In words at most so many culprits of one kind of repair; all are counted, and in `ids`.
inline constexpr std::size_t max_listed = 20;

struct RepairList {
  std::size_t count = 0;
  std::string words;
  Diagnostic diagnostic;
  /// One more; `text` is asked for only while it is listed.
  template <class Text>
  void add(Text&& text, std::initializer_list<std::int64_t> ids) {
    if (count < max_listed) words += (count == 0 ? "" : ", ") + text();
    if (count == max_listed) words += ", ...";
    ++count;
    diagnostic.ids.insert(diagnostic.ids.end(), ids);
  }
  /// Appends "<what>: <count> (<words>)" if there were any.
  void report(Errc code, const std::string& what, const std::string& file, std::vector<Diagnostic>& out);
};

/// An input facet as triangles, or a planar part of one that is bent, before grouping.
struct TriangulatedFacet {
  std::uint32_t input = 0;  ///< index in Plc::facets
  std::uint32_t first = 0, count = 0;
  int axis = 2;
  bool planar = true;
  double defect = 0;
  bool reversed = false;  ///< its triangles run against its first polygon
  bool mixed = false;     ///< some triangles were made anew together with those of other facets
};

/// A facet all of whose points lie on one line, by these points along it.
struct FlatFacet {
  std::uint32_t input;
  std::vector<std::uint32_t> vertices;
};

/// An edge of an input facet or segment.
struct OwnedEdge {
  PlanarEdge edge;
  std::uint32_t owner;
};

/// Two pieces that meet where they should not: triangles, then edges of no triangle, then points of neither.
struct FoundContact {
  std::uint32_t first, second;
  Contact what;
};

/// A point, and the key of an edge (or the number of a triangle) with the point inside.
using PointOn = std::pair<std::uint64_t, std::uint32_t>;

/// A point near an edge, by the key of that, and how far on the way from its first end; sorted, in their order along each edge.
struct NearPoint {
  std::uint64_t key;
  double part;
  std::uint32_t point;
  bool operator<(const NearPoint& o) const { return std::tie(key, part, point) < std::tie(o.key, o.part, o.point); }
};

inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}
inline PlanarEdge edge_of(std::uint64_t key) {
  return {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)};
}

/// What is near to what it does not belong to.
struct NearContacts {
  std::vector<NearPoint> on_edges;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> in_facets;  ///< input facet, point; sorted
};

/// An input facet by domain points.
struct CleanFacet {
  std::vector<std::vector<std::uint32_t>> loops;  ///< no two neighbours equal
  std::vector<std::uint32_t> vertices;            ///< sorted, distinct
  std::vector<PlanarEdge> edges;                  ///< sorted, distinct, smaller index first
};

/// One use of an edge; sorted, the uses of an edge stand together.
struct EdgeUse {
  enum class Kind : std::uint8_t { diagonal, rim, polygon, explicit_segment };  // rim: a constraint of its facet
  std::uint64_t key;       // smaller index in the upper half
  std::uint32_t owner;     // triangulated facet, or for explicit_segment its index in the Plc
  std::uint32_t triangle;  // diagonal and rim only
  Kind kind;
  bool is_triangle() const { return kind == Kind::diagonal || kind == Kind::rim; }
};

}  // namespace detail

template <int D>
class DomainBuilder {
 public:
  /// `refused`: where to name what is invalid and go on without it; null: it is thrown.
  DomainBuilder(const Plc<D>& plc, Domain<D>& domain, std::stop_token stop, std::vector<Diagnostic>* refused = nullptr)
      : plc_(plc), out_(domain), bulk_(true, stop), stop_check_(std::move(stop)), refused_(refused) {}
  void run();

 private:
  using Triangle = std::array<std::uint32_t, 3>;

  // domain.cpp
  std::int64_t number(std::size_t i) const { return static_cast<std::int64_t>(i) + plc_.first_index; }
  std::int64_t point_number(std::uint32_t v) const { return number(out_.input_of_point_[v]); }
  std::string point_words(std::uint32_t v) const;
  [[noreturn]] void fail(Errc code, const std::string& message, const std::vector<std::uint32_t>& lines,
                         std::size_t item, const std::vector<std::int64_t>& ids,
                         const std::vector<std::array<double, 3>>& where) const;
  template <class Action>
  void attempt(Action&& action) const {
    if (refused_ == nullptr) return action();
    try {
      action();
    } catch (const InputError& e) {
      refused_->push_back(e.diagnostic());
    }
  }
  void warn(Errc code, const std::string& message, const std::vector<std::uint32_t>& lines, std::size_t item,
            std::vector<std::int64_t> ids);
  void report_repairs();

  // domain_points.cpp
  void check_finite() const;
  void check_indices() const;
  void check_segments();
  void take_line_facets() requires(D == 3);
  void check_spans_space() const;
  void choose_scale();

  // domain_merge.cpp
  std::size_t attributes_per_point() const;
  void keep_point(std::uint32_t i, const Point<D>& p, std::size_t attributes);
  void merge_points();

  // domain_facets.cpp
  void triangulate_facets() requires(D == 3);
  void triangulate_joined_facets() requires(D == 3);
  detail::CleanFacet clean(std::uint32_t f) requires(D == 3);
  bool add_triangle(std::uint32_t f) requires(D == 3);
  bool set_flat_aside(std::uint32_t f) requires(D == 3);
  void add_polygons(std::uint32_t f) requires(D == 3);
  bool split_at_own_points(detail::CleanFacet& facet) requires(D == 3);
  void carve(std::uint32_t f) requires(D == 3);
  void constrain_explicit(const detail::CleanFacet& facet) requires(D == 3);
  bool is_reversed(const detail::CleanFacet& facet) const requires(D == 3);
  std::array<double, 3> facet_normal(const detail::CleanFacet& facet) const requires(D == 3);
  [[noreturn]] void fail_facet(std::uint32_t f, const detail::PlanarResult& result) const requires(D == 3);
  [[noreturn]] void fail_degenerate(std::uint32_t f, const std::string& why,
                                    const std::vector<std::uint32_t>& vertices) const requires(D == 3);
  std::array<double, 3> normal(const Triangle& t) const requires(D == 3);
  std::pair<int, int> visible_side(const Triangle& t) const requires(D == 3);

  // domain_near.cpp
  Point<D> scaled_point(std::uint32_t v) const;
  template <std::size_t N>
  detail::Box<3> scaled_box(const std::array<std::uint32_t, N>& corners) const requires(D == 3);
  template <std::size_t N>
  detail::BoxTree<3> widened_boxes(std::span<const std::array<std::uint32_t, N>> simplices) const requires(D == 3);
  std::array<Point<D>, 3> scaled_triangle(std::uint32_t t) const requires(D == 3);
  bool find_near() requires(D == 3);
  std::vector<std::uint64_t> constrained_edges() const requires(D == 3);
  void find_points_near_edges() requires(D == 3);
  void find_points_near_facets(std::vector<std::vector<std::uint32_t>>& points) requires(D == 3);
  template <class Visit>
  void near_edges_and_triangles(const Visit& visit) const requires(D == 3);
  void find_near_inner_edges() requires(D == 3);
  void refuse_near_crossings() const requires(D == 3);
  bool runs_near(std::uint32_t a, std::uint32_t b, std::uint32_t t) const requires(D == 3);
  bool is_nearly_flat(std::span<const detail::EdgeUse> joint) const requires(D == 3);
  std::span<const std::pair<std::uint32_t, std::uint32_t>> near_in_facet(std::uint32_t f) const;
  std::span<const detail::NearPoint> near_on_edge(std::uint64_t key) const;
  std::vector<std::uint32_t> near_chain(std::uint32_t a, std::uint32_t b) const;
  bool is_joined(std::uint32_t f) const requires(D == 3);
  bool is_joined_to_nothing(std::uint32_t f) const requires(D == 3);
  void join(std::uint32_t f, detail::CleanFacet& facet) const requires(D == 3);
  void note_near();

  // domain_bent.cpp
  void measure_planarity(detail::TriangulatedFacet& facet, const detail::CleanFacet& clean) requires(D == 3);
  double extent(const detail::CleanFacet& clean) const requires(D == 3);
  std::vector<std::uint32_t> planar_parts(const detail::TriangulatedFacet& whole) requires(D == 3);
  void add_pieces(const detail::TriangulatedFacet& whole, const detail::CleanFacet& clean) requires(D == 3);

  // domain_contacts.cpp
  void resolve_contacts();
  bool find_contacts();
  void collect_pieces();
  void split_at_points();
  std::vector<std::uint32_t> chain(std::uint32_t a, std::uint32_t b) const;
  std::span<const detail::PointOn> on_edge(std::uint64_t key) const;
  void split_edges(std::vector<detail::OwnedEdge>& edges);
  void split_triangles() requires(D == 3);
  void split_triangle(const detail::TriangulatedFacet& facet, std::span<const detail::PointOn> inside) requires(D == 3);
  static std::uint8_t mask_of(const Triangle& t, const std::vector<std::uint64_t>& fixed);
  void report_points();

  // domain_inner.cpp
  void constrain_inner_edges() requires(D == 3);
  void find_inner_edges() requires(D == 3);
  bool runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const requires(D == 3);
  void join_crossed(std::uint64_t key, std::uint32_t t) requires(D == 3);
  std::uint32_t other_side(std::uint64_t key, std::uint32_t t) const requires(D == 3);
  void retriangulate(std::span<const std::uint32_t> patch, std::span<const std::uint64_t> edges) requires(D == 3);
  std::vector<detail::PlanarEdge> rim_of(std::span<const std::uint32_t> patch, int axis) const requires(D == 3);
  void replace(std::span<const std::uint32_t> patch, const std::vector<std::uint64_t>& fixed,
               const std::vector<std::uint64_t>& edges) requires(D == 3);

  // domain_flat.cpp
  void drop_flat_facets() requires(D == 3);
  bool is_covered(const detail::FlatFacet& facet, const std::vector<detail::PlanarEdge>& edges) const requires(D == 3);
  bool is_covered_nearly(const detail::FlatFacet& facet, const std::vector<detail::PlanarEdge>& edges) const requires(D == 3);

  // domain_groups.cpp
  void drop_repeated_facets() requires(D == 3);
  void collect_edges();
  std::uint32_t root(std::uint32_t f);
  void write_facets() requires(D == 3);
  void write_touching() requires(D == 3);
  void orient_group(DomainFacet& facet) requires(D == 3);
  double level(const DomainFacet& facet, std::span<const std::uint32_t> points) const requires(D == 3);
  void measure_defect(DomainFacet& facet, std::span<const std::uint32_t> points) const requires(D == 3);

  // domain_coplanar.cpp
  void group_coplanar() requires(D == 3);
  void find_joints() requires(D == 3);
  void grow_plane(std::uint32_t seed) requires(D == 3);
  std::pair<std::uint32_t, double> largest_triangle(std::uint32_t f) const requires(D == 3);
  bool is_joint(std::span<const detail::EdgeUse> uses) const requires(D == 3);
  bool is_soft(std::span<const detail::EdgeUse> uses) const requires(D == 3);
  bool is_flat(std::span<const detail::EdgeUse> joint) const requires(D == 3);
  bool opens(std::span<const detail::EdgeUse> joint, int axis) const requires(D == 3);
  std::array<Point<D>, 4> corners(std::span<const detail::EdgeUse> joint) const requires(D == 3);

  // domain_segments.cpp
  void write_segments();
  std::size_t uses_of(std::size_t begin) const;
  void write_segment(std::size_t begin, std::size_t end);
  bool is_in_plc(std::uint32_t segment) const { return segment < plc_.segments.size(); }
  std::uint32_t item_of(std::uint32_t segment) const {
    return is_in_plc(segment) ? segment : line_facets_[segment - plc_.segments.size()];
  }
  int marker_of(std::uint32_t segment) const {
    return is_in_plc(segment) ? plc_.segments[segment].marker : plc_.facets[item_of(segment)].marker;
  }
  void note_repeated(std::uint32_t segment, std::uint32_t first);
  void write_incidences();

  const Plc<D>& plc_;
  Domain<D>& out_;
  const detail::Bulk bulk_;
  const detail::StopCheck stop_check_;
  std::vector<Diagnostic>* refused_;
  double scale_ = 1;                                             // 1 / the largest coordinate, a power of two
  std::vector<std::array<std::uint32_t, 2>> explicit_;           // domain points of Plc::segments, then of line_facets_
  std::vector<std::uint32_t> line_facets_;                       // of each further segment its facet
  std::vector<std::uint32_t> explicit_begin_, explicit_at_;      // explicit segments by their first domain point
  std::vector<detail::TriangulatedFacet> facets_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> masks_;                              // bit i: edge i of the triangle is a constraint
  std::vector<detail::OwnedEdge> polygon_edges_;                 // of facets that are no single triangle
  std::vector<detail::OwnedEdge> segment_edges_;                 // explicit segments, or what they were split into
  std::vector<detail::FlatFacet> flat_facets_;
  detail::NearContacts near_;                                    // nothing unless the caller wants points merged
  double near_width_ = 0;                                        // within which, times scale_; 0 likewise
  std::vector<std::uint32_t> facet_of_;                          // of each triangle, in facets_
  std::vector<detail::Piece> pieces_;
  std::vector<detail::FoundContact> contacts_;
  std::vector<detail::PointOn> on_edges_, in_triangles_;         // sorted, distinct
  std::vector<std::array<std::uint32_t, 3>> split_edges_, attached_;  // for the report: point, edge; point, facet, 0
  std::vector<std::pair<std::uint32_t, std::uint64_t>> inner_edges_;  // (triangle, edge that runs inside it)
  std::vector<Triangle> made_;                                   // triangles_ and masks_ as they will be
  std::vector<std::uint8_t> made_masks_;
  std::vector<std::uint64_t> blocked_;                           // of these, edges that cross what is fixed
  std::vector<std::uint64_t> given_up_;                          // edges that were inside of what was triangulated anew
  std::vector<detail::EdgeUse> uses_;
  std::vector<bool> soft_;                                       // by position in uses_: no segment for this edge
  std::vector<std::uint32_t> joint_begin_, joints_;              // of each of facets_: positions in uses_
  std::vector<std::uint8_t> grouped_;                            // of each: none yet, exactly in its group's plane, near it
  std::vector<std::uint32_t> parent_;                            // union-find over facets_ (or, before, triangles_)
  std::vector<EntityId> group_of_;                               // domain facet of each of facets_
  std::vector<std::pair<EntityId, EntityId>> facet_segment_;     // (facet, segment)
  detail::PlanarTriangulation planar_;
  detail::RepairList merged_, negative_zeros_, dropped_edges_, repeated_segments_, repeated_facets_, points_on_edges_,
      points_in_facets_, edges_in_facets_, dropped_flat_, dropped_bare_, bent_facets_, merged_near_;
};

}  // namespace pgdr
