// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numbers/simplex_shapes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/circumsphere.hpp"

namespace pgdr {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;

constexpr double degrees = 180 / std::numbers::pi;

/// Angle between two vectors, accurate near 0 and 180 too.
template <std::size_t N>
double angle_between(const std::array<double, N>& u, const std::array<double, N>& v) {
  const double c = dot(u, v);
  double s;
  if constexpr (N == 2) {
    s = std::abs(u[0] * v[1] - u[1] * v[0]);
  } else {
    const auto w = cross(u, v);
    s = std::sqrt(dot(w, w));
  }
  return std::atan2(s, c) * degrees;
}

template <int D>
constexpr std::size_t angle_count = D == 2 ? 3 : 6;

constexpr double cosine_error = 1e-9;  ///< what the cosines below are good to, generously

/// The cosines of all angles of a simplex, in any order; false if they may be less accurate than that.
bool cosines(const Simplex<2>& s, std::array<double, 3>& cosine) {
  const std::array<detail::Vector<2>, 3> edge{difference(s[1], s[0]), difference(s[2], s[1]), difference(s[0], s[2])};
  std::array<double, 3> length2;
  for (std::size_t i = 0; i < 3; ++i) length2[i] = dot(edge[i], edge[i]);
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    cosine[i] = -dot(edge[i], edge[j]) / std::sqrt(length2[i] * length2[j]);
    good = good && std::abs(cosine[i]) <= 1 + cosine_error;
  }
  return good;
}

/// Those between the normals of the faces; that of a needle is inaccurate.
bool cosines(const Simplex<3>& s, std::array<double, 6>& cosine) {
  const auto a = difference(s[1], s[0]), b = difference(s[2], s[0]), c = difference(s[3], s[0]);
  const auto d = difference(s[2], s[1]), e = difference(s[3], s[1]);
  const std::array<detail::Vector<3>, 4> normal{cross(d, e), cross(c, b), cross(a, c), cross(b, a)};
  // At most about 4 rounding errors of the product of two edges, which is less than this root.
  const double edges2 = dot(a, a) + dot(b, b) + dot(c, c) + dot(d, d) + dot(e, e), least = 1e-10 * edges2 * edges2;
  std::array<double, 4> length2, inverse;
  bool good = true;
  for (std::size_t i = 0; i < 4; ++i) {
    length2[i] = dot(normal[i], normal[i]);
    inverse[i] = 1 / std::sqrt(length2[i]);
    good = good && length2[i] > least;
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j, ++n) {
      cosine[n] = -dot(normal[i], normal[j]) * inverse[i] * inverse[j];
      good = good && std::abs(cosine[n]) <= 1 + cosine_error;
    }
  return good;
}

/// The bin of an angle, by its cosine, without an arcus function: a table of intervals, none of which has two limits of bins,
/// or one near its ends.
class CosineBins {
 public:
  CosineBins() {
    for (int k = 1; k < 18; ++k) {
      const double limit = std::cos(10 * k / degrees);
      const std::size_t at = interval(limit);
      intervals_[at].limit = limit;
      for (std::size_t i = 0; i < at; ++i) ++intervals_[i].bin;
    }
  }
  /// -1 if the cosine is too near to a limit to tell. @pre |cosine| <= 1 + cosine_error
  int bin(double cosine) const {
    const Interval& i = intervals_[interval(cosine)];
    if (std::abs(cosine - i.limit) < cosine_error) return -1;
    return i.bin + (cosine < i.limit ? 1 : 0);
  }

 private:
  struct Interval {
    double limit = -2;
    int bin = 0;  ///< of the cosines above the limit
  };
  static std::size_t interval(double cosine) { return static_cast<std::size_t>((cosine + 1.003) * 128); }

  std::array<Interval, 258> intervals_;
};

/// Adds one cell after the other to a histogram, most of them by cosines alone. What it finds is as if every angle had been
/// computed by angles_deg.
template <int D>
class AngleSummary {
 public:
  explicit AngleSummary(QualitySummary& summary) : summary_(&summary) {}

  void add(const Simplex<D>& s) {
    std::array<double, angle_count<D>> cosine;
    std::array<int, angle_count<D>> bin;
    bool plain = cosines(s, cosine);
    for (std::size_t i = 0; plain && i < cosine.size(); ++i) {
      bin[i] = bins_.bin(cosine[i]);
      plain = bin[i] >= 0 && cosine[i] < most_ - cosine_error && cosine[i] > least_ + cosine_error;
    }
    if (!plain) return look(s);
    for (const int b : bin) ++summary_->histogram[static_cast<std::size_t>(b)];
  }

 private:
  void look(const Simplex<D>& s) {
    for (const double a : angles_deg<D>(s)) {
      summary_->min_angle_deg = std::min(summary_->min_angle_deg, a);
      summary_->max_angle_deg = std::max(summary_->max_angle_deg, a);
      ++summary_->histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(a / 10), 0, 17))];
    }
    most_ = std::cos(summary_->min_angle_deg / degrees);
    least_ = std::cos(summary_->max_angle_deg / degrees);
  }

  QualitySummary* summary_;
  CosineBins bins_;
  double most_ = -1, least_ = 1;  ///< of the cosines of the angles that were looked at
};

}  // namespace

template <int D>
std::array<double, D == 2 ? 3 : 6> angles_deg(const Simplex<D>& s) {
  if constexpr (D == 2) {
    std::array<double, 3> angle;
    for (int i = 0; i < 3; ++i) angle[i] = angle_between(difference(s[(i + 1) % 3], s[i]), difference(s[(i + 2) % 3], s[i]));
    return angle;
  } else {
    // At edge ij the dihedral angle is that between the parts of ik and il normal to ij.
    constexpr int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    std::array<double, 6> angle;
    for (int e = 0; e < 6; ++e) {
      const auto& [i, j, k, l] = edges[e];
      const auto axis = difference(s[j], s[i]);
      angle[e] = angle_between(cross(axis, difference(s[k], s[i])), cross(axis, difference(s[l], s[i])));
    }
    return angle;
  }
}

template <int D>
QualitySummary summarize_quality(const OutputMesh<D>& mesh) {
  constexpr std::size_t blocks = 8, batch = blocks * shape_lanes;
  QualitySummary q;
  AngleSummary<D> angles(q);
  double most_ratio2 = 0;
  std::array<SimplexBlock<D>, blocks> corners;
  std::array<ShapeBlock<D>, blocks> shapes;
  std::array<Simplex<D>, batch> simplices;
  for (std::size_t first = 0; first < mesh.cells.size(); first += batch) {
    const std::size_t count = std::min(batch, mesh.cells.size() - first);
    for (std::size_t n = 0; n < batch; ++n) {
      const auto& cell = mesh.cells[first + std::min(n, count - 1)];
      for (int i = 0; i <= D; ++i) {
        simplices[n][i] = mesh.points[cell[i]];
        corners[n / shape_lanes].set(n % shape_lanes, i, simplices[n][i]);
      }
    }
    simplex_shapes<D>(corners, shapes);
    for (std::size_t n = 0; n < count; ++n) {
      const ShapeBlock<D>& shape = shapes[n / shape_lanes];
      const std::size_t lane = n % shape_lanes;
      const bool known = shape.center_error[lane] < std::numeric_limits<double>::infinity();
      const double radius2 = known ? shape.squared_radius[lane] : circumsphere<D>(simplices[n]).squared_radius;
      most_ratio2 = std::max(most_ratio2, radius2 / shape.shortest_edge_squared[lane]);
      angles.add(simplices[n]);
    }
  }
  q.max_radius_edge = std::sqrt(most_ratio2);
  return q;
}

template PGDR_API std::array<double, 3> angles_deg<2>(const Simplex<2>&);
template PGDR_API std::array<double, 6> angles_deg<3>(const Simplex<3>&);
template PGDR_API QualitySummary summarize_quality<2>(const OutputMesh<2>&);
template PGDR_API QualitySummary summarize_quality<3>(const OutputMesh<3>&);

}  // namespace pgdr
