// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangles of a surface that changes, and what hangs together: a 2-complex, no manifold. Three faces at an edge, borders and
// pinched points are normal. An edge is plain if exactly two faces of one class have it and it is nothing else; all other edges
// are kept, as parts of curves. No decision depends on numbers of points or faces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/surface.hpp"
#include "space/box.hpp"

namespace pgdr::detail {

inline constexpr std::uint32_t no_index = 0xffffffffu;  ///< no point, face, group, curve

/// A triangle. Its corners run one way round in a face and its neighbours only where the input's do.
struct SurfaceFace {
  std::array<std::uint32_t, 3> corners{no_index, no_index, no_index};
  std::uint32_t klass = 0;         ///< of its marker and its body
  std::uint32_t group = no_index;  ///< the flat group
  bool alive = true;
  std::uint64_t born = 0;  ///< as the how manyth of all faces it has come; put back it is the same one
};

/// Seen from one end.
struct KeptEdge {
  std::uint32_t other;  ///< end
  std::uint32_t curve;
};

/// What the faces of one class stand for.
struct SurfaceClass {
  int marker = 0;
  std::uint32_t body = 0;
  bool is_fixed = false;  ///< no face of it ever goes
};

/// What the edges of one curve are.
struct SurfaceCurve {
  bool is_explicit = false;  ///< the input has it as segments, or as edges inside of a polygon
  int marker = 0;            ///< of these segments
  bool is_crease = false;    ///< kept for its angle alone
};

/// Faces that hang together across plain edges in one plane, up to the distance of flat groups.
struct FlatGroup {
  Point3 anchor;         ///< on the plane
  Vector<3> normal{};    ///< of length 1
  int axis = 2;          ///< the coordinate dropped in its projection
  double bend = 0;       ///< most_bend_of() it as given
  bool is_wide = false;  ///< it may not be broken
};

/// How a vertex may change: 0, anywhere; 1, along its curve; 2, never.
enum class VertexOrder : std::uint8_t { free, on_curve, fixed };

class SurfaceComplex {
 public:
  std::vector<Point3> points;
  std::vector<SurfaceFace> faces;
  std::vector<std::vector<std::uint32_t>> faces_at;  ///< of each point
  std::vector<std::vector<KeptEdge>> kept_at;        ///< of each point
  std::vector<VertexOrder> order;                    ///< of each point
  std::vector<SurfaceClass> classes;
  std::vector<SurfaceCurve> curves;
  std::vector<FlatGroup> groups;
  double flatness = 0;  ///< corners of a group are no farther from its plane, however large it is
  double joined = 0;    ///< what is within this of one plane is one facet of the input

  const Point3& at(std::uint32_t v) const { return points[v]; }
  std::array<Point3, 3> triangle(std::uint32_t f) const {
    const auto& c = faces[f].corners;
    return {points[c[0]], points[c[1]], points[c[2]]};
  }
  bool has_corner(std::uint32_t f, std::uint32_t v) const {
    const auto& c = faces[f].corners;
    return c[0] == v || c[1] == v || c[2] == v;
  }
  /// The curve of a kept edge; no_index: it is plain, or no edge.
  std::uint32_t curve_of(std::uint32_t a, std::uint32_t b) const {
    for (const KeptEdge& e : kept_at[a])
      if (e.other == b) return e.curve;
    return no_index;
  }
  bool is_kept(std::uint32_t a, std::uint32_t b) const { return curve_of(a, b) != no_index; }
  bool is_fixed(std::uint32_t f) const { return classes[faces[f].klass].is_fixed; }
  /// When the youngest face at a vertex was born. As long as it is the same, all faces at the vertex are: whatever takes some
  /// away puts others there.
  std::uint64_t youngest_at(std::uint32_t v) const {
    std::uint64_t youngest = 0;
    for (const std::uint32_t f : faces_at[v]) youngest = std::max(youngest, faces[f].born);
    return youngest;
  }
  /// How many faces have been born, those that were taken back among them.
  std::uint64_t births() const { return births_; }
  /// The faces at an edge.
  template <class Visit>
  void each_face_at(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    for (const std::uint32_t f : faces_at[a])
      if (has_corner(f, b)) visit(f);
  }
  std::vector<std::uint32_t> faces_of_edge(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> out;
    each_face_at(a, b, [&](std::uint32_t f) { out.push_back(f); });
    return out;
  }
  /// The face beyond a plain edge; no_index: there is none.
  std::uint32_t beyond(std::uint32_t f, std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t g : faces_at[a])
      if (g != f && has_corner(g, b)) return g;
    return no_index;
  }
  /// All vertices that share an edge with v, kept ones without faces among them, ascending.
  std::vector<std::uint32_t> neighbours(std::uint32_t v) const;

  void keep(std::uint32_t a, std::uint32_t b, std::uint32_t curve) {
    kept_at[a].push_back({b, curve});
    kept_at[b].push_back({a, curve});
  }
  void release(std::uint32_t a, std::uint32_t b);
  std::uint32_t add_point(const Point3& p, VertexOrder o);
  std::uint32_t add_face(const SurfaceFace& face);
  void remove_face(std::uint32_t f);
  /// A face that was removed is there again.
  void put_back_face(std::uint32_t f);
  /// Takes the last face away, with its number. @pre it is there
  void drop_last_face();
  /// Takes the last point away, with its number. @pre nothing has it
  void drop_last_point();

 private:
  std::uint64_t births_ = 0;
};

/// Is one before the other, in an order of triangles that the numbers of points have no part in? By their corners in ascending
/// order.
bool triangle_less(std::array<Point3, 3> a, std::array<Point3, 3> b);
/// The corners in lexicographic order.
inline void sort_corners(std::array<Point3, 3>& t) {
  std::sort(t.begin(), t.end(), [](const Point3& a, const Point3& b) { return lex_less(a, b); });
}
/// The distance of p from the group's plane.
inline double height_over(const FlatGroup& g, const Point3& p) {
  const double h = dot(g.normal, difference(p, g.anchor));
  return h < 0 ? -h : h;
}

/// What corners of a group of this box may be off the plane of its largest face, so that the mesher takes it for one facet.
double most_bend_of(const SurfaceComplex& s, const Box<3>& box);

/// What does not change: segments without faces, and points of neither.
struct LoosePieces {
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> points;
};

/// The surface of a Domain, with its curves and the orders of its vertices.
/// @param input  that of the Domain
/// @param tolerance  E
SurfaceComplex make_complex(const Plc<3>& input, const Domain<3>& domain, double tolerance, const SurfaceOptions& options,
                            LoosePieces& loose, std::uint64_t& crease_count);
/// Finds the flat groups. @param flatness, joined  as of SurfaceComplex
void find_groups(SurfaceComplex& surface, double flatness, double joined, double tolerance);

}  // namespace pgdr::detail
