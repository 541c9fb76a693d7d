// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/quality.hpp"

namespace pgdr::tool {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
double dot(const Point<D>& a, const Point<D>& b) {
  double sum = 0;
  for (int i = 0; i < D; ++i) sum += a[i] * b[i];
  return sum;
}

template <int D>
Point<D> minus(const Point<D>& a, const Point<D>& b) {
  Point<D> c;
  for (int i = 0; i < D; ++i) c[i] = a[i] - b[i];
  return c;
}

Point3 cross(const Point3& a, const Point3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

template <int D>
Point<D> unit(Point<D> a) {
  const double length = std::sqrt(dot(a, a));
  for (double& x : a.x) x /= length;
  return a;
}

template <int D>
Simplex<D> simplex(const OutputMesh<D>& mesh, std::size_t cell) {
  Simplex<D> s;
  for (std::size_t i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[cell][i]];
  return s;
}

/// Normal, of any length, of the face opposite corner i, away from it.
template <int D>
Point<D> outward(const Simplex<D>& s, std::size_t i) {
  const Point<D>& a = s[(i + 1) % (D + 1)];
  const Point<D> u = minus(s[(i + 2) % (D + 1)], a);
  Point<D> n;
  if constexpr (D == 2)
    n = {{u[1], -u[0]}};
  else
    n = cross(u, minus(s[(i + 3) % (D + 1)], a));
  if (dot(n, minus(s[i], a)) > 0)
    for (double& x : n.x) x = -x;
  return n;
}

/// Smallest (dihedral) angle over that of the regular simplex: 0 is flat, 1 the best there is.
template <int D>
double quality(const Simplex<D>& s) {
  std::array<Point<D>, D + 1> normals;
  for (std::size_t i = 0; i <= D; ++i) normals[i] = unit(outward(s, i));
  double smallest = pi;
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double cosine = -dot(normals[i], normals[k]);
      if (!(cosine < 1)) return 0;  // flat, or no number
      smallest = std::min(smallest, std::acos(std::max(-1.0, cosine)));
    }
  return std::min(1.0, smallest / std::acos(1.0 / D));
}

/// In degrees.
template <int D>
double smallest_angle(const Simplex<D>& s) {
  const auto angles = angles_deg<D>(s);
  return *std::min_element(angles.begin(), angles.end());
}

Color mix(const Color& a, const Color& b, double t) {
  const auto channel = [t](double from, double to) { return static_cast<std::uint8_t>(std::lround(from + t * (to - from))); };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue)};
}

/// From red (poor) to blue (good).
Color quality_color(double q) {
  const double at = q * (quality_stops.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(at), quality_stops.size() - 2);
  return mix(quality_stops[i], quality_stops[i + 1], at - static_cast<double>(i));
}

/// The colour of the class of an angle in degrees.
Color angle_color(double angle) {
  return angle_classes[static_cast<std::size_t>(std::upper_bound(angle_limits.begin(), angle_limits.end(), angle) -
                                                angle_limits.begin())];
}

/// The colour of each cell, before light falls on it.
template <int D>
class Colors {
 public:
  Colors(const OutputMesh<D>& mesh, ViewColor by) : mesh_(mesh), by_(by), labels_(mesh.regions) {
    if (by == ViewColor::leaf) labels_.assign(mesh.leaves.begin(), mesh.leaves.end());
    std::sort(labels_.begin(), labels_.end());
    labels_.erase(std::unique(labels_.begin(), labels_.end()), labels_.end());
  }
  Color of(std::size_t cell) const {
    if (by_ == ViewColor::quality) return quality_color(quality(simplex(mesh_, cell)));
    if (by_ == ViewColor::dihedral) return angle_color(smallest_angle(simplex(mesh_, cell)));
    if (labels_.empty()) return region_color(0);
    const double label = by_ == ViewColor::leaf ? static_cast<double>(mesh_.leaves[cell]) : mesh_.regions[cell];
    const auto at = std::lower_bound(labels_.begin(), labels_.end(), label);
    return region_color(static_cast<std::size_t>(at - labels_.begin()));
  }

 private:
  const OutputMesh<D>& mesh_;
  ViewColor by_;
  std::vector<double> labels_;
};

/// Where pixels are: `scale` of them a unit of length.
class Frame {
 public:
  void include(const Point2& p) {
    for (int i = 0; i < 2; ++i) {
      low_[i] = std::min(low_[i], p[i]);
      high_[i] = std::max(high_[i], p[i]);
    }
  }
  /// As wide as asked for, and as high as that makes it, but at most four times as high: then with empty sides.
  /// @throws InputError if what is included has no extent, or more than a number can tell
  void fit(int width, Picture& picture, const std::string& file) {
    const double margin = std::max(2.0, 0.02 * width), room = width - 2 * margin;
    const double dx = high_[0] - low_[0], dy = high_[1] - low_[1];
    scale_ = std::min(room / dx, (4.0 * width - 2 * margin) / dy);
    if (!(dx >= 0 && dy >= 0 && scale_ > 0 && std::isfinite(scale_)))
      throw InputError({.code = Errc::no_volume, .message = "the mesh has no extent that can be drawn", .file = file});
    picture.width = width;
    picture.height = static_cast<int>(std::ceil(dy * scale_ + 2 * margin));
    left_ = 0.5 * (width - dx * scale_);
    top_ = 0.5 * (picture.height - dy * scale_);
  }
  Pixel pixel(const Point2& p) const {
    return {static_cast<float>(left_ + (p[0] - low_[0]) * scale_), static_cast<float>(top_ + (high_[1] - p[1]) * scale_)};
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Point2 low_{{infinity, infinity}}, high_{{-infinity, -infinity}};
  double scale_ = 1, left_ = 0, top_ = 0;
};

/// Edges of small triangles fade into their colour: ink would drown it, and without any there would be seams.
void add(Picture& picture, const std::array<Pixel, 3>& corners, const Color& fill) {
  const auto& [a, b, c] = corners;
  const double area2 = std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  constexpr double none = 1.5, full = 14;  // pixels a side
  const double strength = std::clamp((std::sqrt(area2) - none) / (full - none), 0.0, 1.0);
  picture.triangles.push_back({corners, fill, mix(fill, ink, 0.85 * std::sqrt(strength))});
}

[[noreturn]] void refuse(const char* why) { throw UsageError({.code = Errc::bad_option, .message = why}); }

Picture draw_plane(const OutputMesh<2>& mesh, const ViewArguments& a) {
  if (a.cut || a.from) refuse("--cut and --from are for 3D");
  Frame frame;
  for (const auto& cell : mesh.cells)
    for (const auto v : cell) frame.include(mesh.points[v]);
  Picture picture;
  frame.fit(a.width, picture, a.mesh);
  const Colors<2> colors(mesh, a.color);
  picture.triangles.reserve(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Simplex<2> s = simplex(mesh, c);
    add(picture, {frame.pixel(s[0]), frame.pixel(s[1]), frame.pixel(s[2])}, colors.of(c));
  }
  for (const auto& s : mesh.subsegments)
    picture.lines.push_back({frame.pixel(mesh.points[s.vertices[0]]), frame.pixel(mesh.points[s.vertices[1]])});
  return picture;
}

/// The eye, infinitely far away: the axes of the picture in space. `back` points to the eye.
struct Camera {
  Point3 right, up, back;

  explicit Camera(const Point3& from) : back(unit(from)) {
    const bool from_above = std::abs(back[0]) + std::abs(back[1]) < 1e-9;
    right = unit(cross(from_above ? Point3{{0, 1, 0}} : Point3{{0, 0, 1}}, back));
    up = cross(back, right);
  }
  Point2 flat(const Point3& p) const { return {{dot(p, right), dot(p, up)}}; }
};

struct Face {
  std::uint32_t cell = 0;
  std::uint8_t opposite = 0;  ///< corner of the cell
  bool opened = false;        ///< by the cut
};

/// Which cells a cut keeps: those beyond the plane, seen from the eye.
std::vector<bool> kept_cells(const OutputMesh<3>& mesh, const ViewArguments& a, const Point3& from) {
  std::vector<bool> kept(mesh.cells.size(), true);
  if (!a.cut) return kept;
  const int axis = a.cut->axis;
  const bool below = from[axis] >= 0;
  for (std::size_t c = 0; c < kept.size(); ++c) {
    double centroid = 0;
    for (const auto v : mesh.cells[c]) centroid += mesh.points[v][axis] / 4;
    kept[c] = below ? centroid <= a.cut->value : centroid >= a.cut->value;
  }
  if (std::find(kept.begin(), kept.end(), true) == kept.end()) refuse("--cut leaves no cell");
  return kept;
}

/// Faces of exactly one kept cell.
std::vector<Face> surface(const OutputMesh<3>& mesh, const std::vector<bool>& kept) {
  struct Side {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t cell, opposite;
  };
  std::vector<Side> sides;
  sides.reserve(4 * mesh.cells.size());
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const auto& v = mesh.cells[c];
      Side side{{v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]}, c, i};
      std::sort(side.vertices.begin(), side.vertices.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.vertices != b.vertices ? a.vertices < b.vertices : a.cell < b.cell; });
  std::vector<Face> faces;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    std::size_t one = 0, count = 0;
    for (end = i; end < sides.size() && sides[end].vertices == sides[i].vertices; ++end)
      if (kept[sides[end].cell]) one = end, ++count;
    if (count == 1) faces.push_back({sides[one].cell, static_cast<std::uint8_t>(sides[one].opposite), end - i > 1});
  }
  return faces;
}

/// Larger is nearer. Along a ray the powers with regard to the spheres of a Delaunay triangulation's cells grow, so that
/// the heights of the circumcentres sort the cells, and with them the faces before them, exactly (Edelsbrunner 1990, "An
/// acyclicity theorem for cell complexes in d dimensions"). In other meshes it is a rule of thumb.
double height(const Simplex<3>& s, const Point3& back) {
  double centroid = 0;
  for (const Point3& p : s) centroid += dot(p, back) / 4;
  if (orient(s) == Sign::zero) return centroid;
  const double center = dot(circumsphere(s).center, back);
  return std::isfinite(center) ? center : centroid;
}

Picture draw_space(const OutputMesh<3>& mesh, const ViewArguments& a) {
  const Point3 from = a.from.value_or(Point3{{1, -1.5, 0.8}});
  const Camera eye(from);
  Point3 light;
  for (int i = 0; i < 3; ++i) light[i] = 0.6 * eye.back[i] + 0.65 * eye.up[i] - 0.35 * eye.right[i];
  light = unit(light);

  const std::vector<Face> faces = surface(mesh, kept_cells(mesh, a, from));
  Frame frame;
  std::vector<std::pair<double, std::size_t>> order;  // of faces that look at the eye
  std::vector<Point3> normals(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Simplex<3> s = simplex(mesh, faces[f].cell);
    for (std::size_t i = 1; i < 4; ++i) frame.include(eye.flat(s[(faces[f].opposite + i) % 4]));
    normals[f] = unit(outward(s, faces[f].opposite));
    if (dot(normals[f], eye.back) > 0) order.emplace_back(height(s, eye.back), f);
  }
  std::sort(order.begin(), order.end());

  Picture picture;
  frame.fit(a.width, picture, a.mesh);
  const Colors<3> colors(mesh, a.color);
  picture.triangles.reserve(order.size());
  for (const auto& [nearness, f] : order) {
    const Simplex<3> s = simplex(mesh, faces[f].cell);
    const bool colored = faces[f].opened || a.color != ViewColor::quality;
    const double brightness = 0.62 + 0.38 * std::max(0.0, dot(normals[f], light));
    const Color fill = mix({}, colored ? colors.of(faces[f].cell) : plain_cell,
                           faces[f].opened ? 0.8 + 0.2 * brightness : brightness);
    std::array<Pixel, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = frame.pixel(eye.flat(s[(faces[f].opposite + i + 1) % 4]));
    add(picture, corners, fill);
  }
  return picture;
}

}  // namespace

template <int D>
Picture draw(const OutputMesh<D>& mesh, const ViewArguments& a) {
  if (mesh.cells.empty())
    throw InputError({.code = Errc::encloses_nothing, .message = "there are no cells to draw", .file = a.mesh});
  if constexpr (D == 2)
    return draw_plane(mesh, a);
  else
    return draw_space(mesh, a);
}

template Picture draw<2>(const OutputMesh<2>&, const ViewArguments&);
template Picture draw<3>(const OutputMesh<3>&, const ViewArguments&);

}  // namespace pgdr::tool
