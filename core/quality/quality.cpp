// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "numbers/simplex_shapes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/circumsphere.hpp"
#include "quality/cell_proportions.hpp"
#include "quality/quality_counts.hpp"
#include "space/bulk.hpp"

namespace pgdr {
// Named, since lambdas of exported templates capture its types.
namespace measuring {

using detail::cross;
using detail::difference;
using detail::dot;

using detail::QualityCounts;
using detail::ValuesOfCells;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double unit = 0x1p53;  // a value of 1 in MeasureCounts

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

/// The class of 5 degrees of an angle, by its cosine, without an arcus function: a table of intervals, none of which has two
/// limits of classes, or one near its ends.
class CosineBins {
 public:
  CosineBins() {
    for (int k = 1; k < count; ++k) {
      const double limit = std::cos(width * k / degrees);
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
  static int bin_of_degrees(double angle) { return std::clamp(static_cast<int>(angle / width), 0, count - 1); }

 private:
  static constexpr int width = 5, count = 180 / width;
  struct Interval {
    double limit = -2;
    int bin = 0;  ///< of the cosines above the limit
  };
  static std::size_t interval(double cosine) { return static_cast<std::size_t>((cosine + 1.003) * 128); }

  std::array<Interval, 258> intervals_;
};

const CosineBins& cosine_bins() {
  static const CosineBins bins;
  return bins;
}

using CellValues = std::array<float, 3>;  // as ValuesOfCells has them

/// Takes in one cell after the other. What it finds of angles is as if every one had been computed by angles_deg, though it
/// computes most cosines alone.
template <int D>
class Sums {
 public:
  /// @param determinant  D! times the measure of the cell
  CellValues add(const Simplex<D>& s, Proportions<D> p, double squared_radius, double shortest_edge_squared, double determinant) {
    counts_.most_ratio2 = std::max(counts_.most_ratio2, squared_radius / shortest_edge_squared);
    const double smallest = add_angles(s, p);
    double radius = std::sqrt(squared_radius);
    if (!p.moderate) rescale(s, p, radius, determinant);
    constexpr double regular = D == 2 ? 2 / std::numbers::sqrt3 : std::numbers::sqrt2;
    const double largest_corner = std::max(std::sqrt(p.largest_corner2), std::abs(determinant));
    ++counts_.cells;
    return {static_cast<float>(1 - smallest), counts_.radius_ratio.add(D * determinant / (p.surface * radius)),
            counts_.scaled_jacobian.add(regular * determinant / largest_corner)};
  }

  const QualityCounts& counts() const { return counts_; }

 private:
  /// @returns the cosine of the smallest angle, which is the same whatever other cells were looked at
  double add_angles(const Simplex<D>& s, const Proportions<D>& p) {
    std::array<int, angle_count<D>> bin;
    bool plain = p.good;
    for (std::size_t i = 0; plain && i < p.cosine.size(); ++i) {
      bin[i] = bins_->bin(p.cosine[i]);
      plain = bin[i] >= 0 && p.cosine[i] < most_ - cosine_error && p.cosine[i] > least_ + cosine_error;
    }
    if (plain) {
      for (const int b : bin) ++counts_.q.histogram[static_cast<std::size_t>(b / 2)];
      count_smallest(*std::min_element(bin.begin(), bin.end()));
    } else if (const double cosine = look(s); !p.good) {
      return cosine;
    }
    return *std::max_element(p.cosine.begin(), p.cosine.end());
  }

  double look(const Simplex<D>& s) {
    const auto angles = angles_deg<D>(s);
    for (const double a : angles) ++counts_.q.histogram[static_cast<std::size_t>(CosineBins::bin_of_degrees(a) / 2)];
    const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
    count_smallest(CosineBins::bin_of_degrees(*smallest));
    counts_.q.min_angle_deg = std::min(counts_.q.min_angle_deg, *smallest);
    counts_.q.max_angle_deg = std::max(counts_.q.max_angle_deg, *largest);
    most_ = std::cos(counts_.q.min_angle_deg / degrees);
    least_ = std::cos(counts_.q.max_angle_deg / degrees);
    return std::cos(*smallest / degrees);
  }

  void count_smallest(int bin) {
    const std::size_t last = counts_.q.cells_by_smallest_angle.size() - 1;
    ++counts_.q.cells_by_smallest_angle[std::min(static_cast<std::size_t>(bin), last)];
  }

  /// The same of a copy of a moderate size.
  static void rescale(const Simplex<D>& s, Proportions<D>& p, double& radius, double& determinant) {
    double longest = 0;
    for (const Point<D>& corner : s)
      for (int k = 0; k < D; ++k) longest = std::max(longest, std::abs(corner[k] - s[0][k]));
    if (!(longest > 0 && std::isfinite(longest))) return;
    const int exponent = std::ilogb(longest);
    Simplex<D> copy;
    for (std::size_t i = 0; i <= D; ++i)
      for (int k = 0; k < D; ++k) copy[i][k] = std::ldexp(s[i][k] - s[0][k], -exponent);
    SimplexBlock<D> block;
    for (std::size_t lane = 0; lane < shape_lanes; ++lane)
      for (int i = 0; i <= D; ++i) block.set(lane, i, copy[i]);
    ProportionsBlock<D> proportions;
    set_proportions<D>({&block, 1}, {&proportions, 1});
    p = Proportions<D>(proportions, 0);
    radius = std::sqrt(circumsphere<D>(copy).squared_radius);
    const detail::Vector<D> u = difference(copy[1], copy[0]), v = difference(copy[2], copy[0]);
    if constexpr (D == 2)
      determinant = u[0] * v[1] - u[1] * v[0];
    else
      determinant = dot(cross(u, v), difference(copy[3], copy[0]));
  }

  const CosineBins* bins_ = &cosine_bins();
  QualityCounts counts_;
  double most_ = -1, least_ = 1;  ///< of the cosines of the angles that were looked at
};

/// By label.
template <int D>
using SumsOfRegions = std::map<double, Sums<D>>;

/// Adds cells from `first` to `last`, and notes their values, one a cell of the mesh.
template <int D>
void add_cells(const OutputMesh<D>& mesh, std::size_t first, std::size_t last, SumsOfRegions<D>& sums, ValuesOfCells& values) {
  constexpr std::size_t blocks = 8, batch = blocks * shape_lanes;
  std::array<SimplexBlock<D>, blocks> corners;
  std::array<ShapeBlock<D>, blocks> shapes;
  std::array<ProportionsBlock<D>, blocks> proportions;
  std::array<Simplex<D>, batch> simplices;
  auto region = sums.end();
  for (; first < last; first += batch) {
    const std::size_t count = std::min(batch, last - first);
    for (std::size_t n = 0; n < batch; ++n) {
      const auto& cell = mesh.cells[first + std::min(n, count - 1)];
      for (int i = 0; i <= D; ++i) {
        simplices[n][i] = mesh.points[cell[i]];
        corners[n / shape_lanes].set(n % shape_lanes, i, simplices[n][i]);
      }
    }
    simplex_shapes<D>(corners, shapes);
    set_proportions<D>(corners, proportions);
    for (std::size_t n = 0; n < count; ++n) {
      const ShapeBlock<D>& shape = shapes[n / shape_lanes];
      const std::size_t lane = n % shape_lanes;
      const bool known = shape.center_error[lane] < std::numeric_limits<double>::infinity();
      const double radius2 = known ? shape.squared_radius[lane] : circumsphere<D>(simplices[n]).squared_radius;
      const double label = detail::label_of(mesh, first + n);
      if (region == sums.end() || region->first != label) region = sums.try_emplace(label).first;
      const CellValues of_cell = region->second.add(simplices[n], {proportions[n / shape_lanes], lane}, radius2,
                                                    shape.shortest_edge_squared[lane], shape.det[lane]);
      for (std::size_t k = 0; k < of_cell.size(); ++k) values[k][first + n] = of_cell[k];
    }
  }
}

}  // namespace measuring

using namespace measuring;

namespace detail {

float MeasureCounts::add(double value) {
  if (!(std::abs(value) <= 1)) value = value > 1 ? 1 : 0;  // by rounding; what is no number is of a flat cell
  least_ = std::min(least_, value);
  sum_ += static_cast<std::int64_t>(value * unit);
  return static_cast<float>(value);
}

void MeasureCounts::add(const MeasureCounts& other) {
  least_ = std::min(least_, other.least_);
  sum_ += other.sum_;
}

MeasureSummary MeasureCounts::summary(std::uint64_t cells) const {
  return {least_, 0, static_cast<double>(sum_) / unit / static_cast<double>(cells)};
}

void QualityCounts::add(const QualityCounts& other) {
  cells += other.cells;
  most_ratio2 = std::max(most_ratio2, other.most_ratio2);
  q.min_angle_deg = std::min(q.min_angle_deg, other.q.min_angle_deg);
  q.max_angle_deg = std::max(q.max_angle_deg, other.q.max_angle_deg);
  for (std::size_t i = 0; i < q.histogram.size(); ++i) q.histogram[i] += other.q.histogram[i];
  for (std::size_t i = 0; i < q.cells_by_smallest_angle.size(); ++i)
    q.cells_by_smallest_angle[i] += other.q.cells_by_smallest_angle[i];
  radius_ratio.add(other.radius_ratio);
  scaled_jacobian.add(other.scaled_jacobian);
}

QualityMeasures QualityCounts::measures() const {
  QualityMeasures measures = q;
  measures.max_radius_edge = std::sqrt(most_ratio2);
  if (cells == 0) return measures;
  measures.radius_ratio = radius_ratio.summary(cells);
  measures.scaled_jacobian = scaled_jacobian.summary(cells);
  return measures;
}

std::vector<CountsOfRegion> joined(const std::vector<CountsOfRegion>& parts) {
  std::map<double, QualityCounts> by_label;
  for (const CountsOfRegion& part : parts) by_label[part.label].add(part.counts);
  std::vector<CountsOfRegion> regions;
  for (const auto& [label, counts] : by_label) regions.push_back({label, counts});
  return regions;
}

template <int D>
MeasuredCells measure_cells(const OutputMesh<D>& mesh, const Bulk& bulk) {
  constexpr std::size_t part_size = 1 << 14;
  const std::size_t count = mesh.cells.size(), parts = (count + part_size - 1) / part_size;
  MeasuredCells measured;
  for (std::vector<float>& v : measured.values) v.resize(count);
  std::vector<SumsOfRegions<D>> sums(parts);
  bulk.parts(parts, [&](std::size_t part) {
    add_cells(mesh, part * part_size, std::min(count, (part + 1) * part_size), sums[part], measured.values);
  });
  for (const SumsOfRegions<D>& part : sums)
    for (const auto& [label, of_part] : part) measured.regions.push_back({label, of_part.counts()});
  measured.regions = joined(measured.regions);
  return measured;
}

template MeasuredCells measure_cells<2>(const OutputMesh<2>&, const Bulk&);
template MeasuredCells measure_cells<3>(const OutputMesh<3>&, const Bulk&);

}  // namespace detail

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

template PGDR_API std::array<double, 3> angles_deg<2>(const Simplex<2>&);
template PGDR_API std::array<double, 6> angles_deg<3>(const Simplex<3>&);

}  // namespace pgdr
