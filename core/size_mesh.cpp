// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes on a background mesh: exact point location by a tree of boxes, nearest point of the boundary outside.
#include <algorithm>
#include <cmath>
#include <memory>

#include "detail/search_tree.hpp"
#include "detail/size_checks.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr {
namespace {

template <int D>
using Cell = std::array<std::uint32_t, D + 1>;
template <int D>
using Face = std::array<std::uint32_t, D>;

template <int D>
Simplex<D> corners_of(const std::vector<Point<D>>& points, const Cell<D>& cell) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = points[cell[i]];
  return s;
}

template <int D>
double dot(const Point<D>& a, const Point<D>& b, const Point<D>& from) {
  double s = 0;
  for (int i = 0; i < D; ++i) s += (a[i] - from[i]) * (b[i] - from[i]);
  return s;
}

/// |determinant| of the edges from the first corner, rounded.
template <int D>
double rounded_measure(const Simplex<D>& s) {
  std::array<std::array<double, D>, D> e;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) e[i][j] = s[i + 1][j] - s[0][j];
  if constexpr (D == 2) {
    return std::abs(e[0][0] * e[1][1] - e[0][1] * e[1][0]);
  } else {
    return std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                    e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]));
  }
}

/// Weights of the point of the segment next to x.
std::array<double, 2> nearest_weights(const std::array<Point2, 2>& face, const Point2& x) {
  const double length = squared_distance(face[0], face[1]);
  const double t = length > 0 ? std::clamp(dot<2>(x, face[1], face[0]) / length, 0.0, 1.0) : 0;
  return {1 - t, t};
}

/// Weights of the point of the triangle next to x (Ericson, Real-Time Collision Detection, 5.1.5).
std::array<double, 3> nearest_weights(const std::array<Point3, 3>& face, const Point3& x) {
  const auto& [a, b, c] = face;
  const double d1 = dot<3>(b, x, a), d2 = dot<3>(c, x, a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double ab = squared_distance(a, b), ac = squared_distance(a, c), ab_ac = dot<3>(b, c, a);
  const double d3 = d1 - ab, d4 = d2 - ab_ac;  // from b: along ab, ac
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 - d3 > 0 ? d1 / (d1 - d3) : 0;
    return {1 - t, t, 0};
  }
  const double d5 = d1 - ab_ac, d6 = d2 - ac;  // from c
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 - d6 > 0 ? d2 / (d2 - d6) : 0;
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double along = (d4 - d3) + (d5 - d6), t = along > 0 ? (d4 - d3) / along : 0;
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {va / sum, vb / sum, vc / sum};
}

/// The weighted mean, never beyond the values.
template <std::size_t N>
double mean(const std::array<double, N>& weight, const std::array<double, N>& value) {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < N; ++i) {
    sum += weight[i] * value[i];
    total += weight[i];
  }
  const auto [least, most] = std::minmax_element(value.begin(), value.end());
  const double m = sum / total;
  return m >= *least ? std::min(m, *most) : *least;  // NaN: weights that underflow
}

template <int D>
class MeshValues {
 public:
  MeshValues(const OutputMesh<D>& mesh, std::span<const double> values)
      : points_(mesh.points),
        values_(values.begin(), values.end()),
        cells_(oriented(mesh)),
        faces_(boundary(cells_)),
        cell_tree_(boxes(cells_)),
        face_tree_(boxes(faces_)) {
    if (cells_.empty()) throw UsageError({Errc::bad_option, "the background mesh has no cell with a volume", {}, 0, {}, {}});
  }

  double at(const Point<D>& x) const {
    std::uint32_t home = none;
    cell_tree_.each_at(x, [&](std::uint32_t c) {
      if (c < home && holds(c, x)) home = c;
    });
    return home != none ? inside(home, x) : outside(x);
  }

 private:
  using Box = detail::SearchBox<D>;
  static constexpr std::uint32_t none = 0xffffffffu;

  /// The cells that are not flat, all positive.
  static std::vector<Cell<D>> oriented(const OutputMesh<D>& mesh) {
    std::vector<Cell<D>> cells;
    for (Cell<D> cell : mesh.cells) {
      const Sign sign = orient<D>(corners_of<D>(mesh.points, cell));
      if (sign == Sign::negative) std::swap(cell[0], cell[1]);
      if (sign != Sign::zero) cells.push_back(cell);
    }
    return cells;
  }
  /// Faces of one cell alone; all if there are none, as where every cell occurs twice.
  static std::vector<Face<D>> boundary(const std::vector<Cell<D>>& cells) {
    std::vector<Face<D>> faces;
    for (const Cell<D>& cell : cells)
      for (int f = 0; f <= D; ++f) {
        Face<D> face;
        for (int i = 0, n = 0; i <= D; ++i)
          if (i != f) face[n++] = cell[i];
        std::sort(face.begin(), face.end());
        faces.push_back(face);
      }
    std::sort(faces.begin(), faces.end());
    std::vector<Face<D>> single;
    for (std::size_t i = 0, next; i < faces.size(); i = next) {
      for (next = i + 1; next < faces.size() && faces[next] == faces[i];) ++next;
      if (next == i + 1) single.push_back(faces[i]);
    }
    return single.empty() ? faces : single;
  }
  template <std::size_t N>
  std::vector<Box> boxes(const std::vector<std::array<std::uint32_t, N>>& simplices) const {
    std::vector<Box> all;
    for (const auto& s : simplices) {
      Box box = Box::empty();
      for (const std::uint32_t v : s) box.add(points_[v]);
      all.push_back(box);
    }
    return all;
  }

  bool holds(std::uint32_t c, const Point<D>& x) const {
    const Simplex<D> corners = corners_of<D>(points_, cells_[c]);
    for (int i = 0; i <= D; ++i) {
      Simplex<D> s = corners;
      s[i] = x;
      if (orient<D>(s) == Sign::negative) return false;
    }
    return true;
  }
  double inside(std::uint32_t c, const Point<D>& x) const {
    const Simplex<D> corners = corners_of<D>(points_, cells_[c]);
    std::array<double, D + 1> weight, value;
    for (int i = 0; i <= D; ++i) {
      Simplex<D> s = corners;
      s[i] = x;
      weight[i] = rounded_measure<D>(s);
      value[i] = values_[cells_[c][i]];
    }
    return mean(weight, value);
  }
  double outside(const Point<D>& x) const {
    double nearest = std::numeric_limits<double>::infinity(), result = values_[faces_[0][0]];
    std::uint32_t best = none;
    face_tree_.search([&](const Box& box) { return box.squared_distance_to(x) * (1 - 0x1p-40); },
                      [&](std::uint32_t f) {
                        std::array<Point<D>, D> face;
                        std::array<double, D> value;
                        for (int i = 0; i < D; ++i) {
                          face[i] = points_[faces_[f][i]];
                          value[i] = values_[faces_[f][i]];
                        }
                        const auto weight = nearest_weights(face, x);
                        Point<D> p{};
                        for (int i = 0; i < D; ++i)
                          for (int j = 0; j < D; ++j) p[j] += weight[i] * face[i][j];
                        const double d = squared_distance(p, x);
                        if (d > nearest || (d == nearest && f > best)) return nearest;
                        nearest = d;
                        best = f;
                        result = mean(weight, value);
                        return nearest;
                      });
    return result;
  }

  std::vector<Point<D>> points_;
  std::vector<double> values_;
  std::vector<Cell<D>> cells_;
  std::vector<Face<D>> faces_;
  detail::SearchTree<D> cell_tree_, face_tree_;
};

}  // namespace

template <int D>
SizingField<D> sizes_on_mesh(const OutputMesh<D>& mesh, std::span<const double> values) {
  detail::require_sizes<D>(mesh.points, values);
  detail::require_indices<D>(mesh);
  return [source = std::make_shared<const MeshValues<D>>(mesh, values)](const Point<D>& x) { return source->at(x); };
}

template PGDR_API SizingField<2> sizes_on_mesh<2>(const OutputMesh<2>&, std::span<const double>);
template PGDR_API SizingField<3> sizes_on_mesh<3>(const OutputMesh<3>&, std::span<const double>);

}  // namespace pgdr
