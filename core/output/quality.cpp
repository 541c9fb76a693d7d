// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "numbers/simplex_shapes.hpp"
#include "numbers/vectors.hpp"
#include "output/cell_proportions.hpp"
#include "pgdr/circumsphere.hpp"
#include "space/bulk.hpp"

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

/// What is measured of one cell, for the quantiles: 1 - cosine of its smallest angle, which tells small angles apart; radius
/// ratio; scaled Jacobian.
using CellValues = std::array<float, 3>;
using ValuesOfCells = std::array<std::vector<float>, 3>;

/// Takes in one cell after the other. What it finds of angles is as if every one had been computed by angles_deg, though it
/// computes most cosines alone.
template <int D>
class Sums {
 public:
  /// @param determinant  D! times the measure of the cell
  CellValues add(const Simplex<D>& s, Proportions<D> p, double squared_radius, double shortest_edge_squared, double determinant) {
    most_ratio2_ = std::max(most_ratio2_, squared_radius / shortest_edge_squared);
    const double smallest = add_angles(s, p);
    double radius = std::sqrt(squared_radius);
    if (!p.moderate) rescale(s, p, radius, determinant);
    constexpr double regular = D == 2 ? 2 / std::numbers::sqrt3 : std::numbers::sqrt2;
    const double largest_corner = std::max(std::sqrt(p.largest_corner2), std::abs(determinant));
    ++cells_;
    return {static_cast<float>(1 - smallest), add(radius_ratio_, D * determinant / (p.surface * radius)),
            add(scaled_jacobian_, regular * determinant / largest_corner)};
  }

  void add(const Sums& other) {
    cells_ += other.cells_;
    most_ratio2_ = std::max(most_ratio2_, other.most_ratio2_);
    q_.min_angle_deg = std::min(q_.min_angle_deg, other.q_.min_angle_deg);
    q_.max_angle_deg = std::max(q_.max_angle_deg, other.q_.max_angle_deg);
    for (std::size_t i = 0; i < q_.histogram.size(); ++i) q_.histogram[i] += other.q_.histogram[i];
    for (std::size_t i = 0; i < q_.cells_by_smallest_angle.size(); ++i)
      q_.cells_by_smallest_angle[i] += other.q_.cells_by_smallest_angle[i];
    radius_ratio_.add(other.radius_ratio_);
    scaled_jacobian_.add(other.scaled_jacobian_);
  }

  std::size_t cells() const { return cells_; }
  /// But for the quantiles.
  QualityMeasures measures() const {
    QualityMeasures q = q_;
    q.max_radius_edge = std::sqrt(most_ratio2_);
    if (cells_ == 0) return q;
    q.radius_ratio = radius_ratio_.summary(cells_);
    q.scaled_jacobian = scaled_jacobian_.summary(cells_);
    return q;
  }

 private:
  struct Measure {
    double least = 1, sum = 0;
    void add(const Measure& other) {
      least = std::min(least, other.least);
      sum += other.sum;
    }
    MeasureSummary summary(std::size_t cells) const { return {least, 0, sum / static_cast<double>(cells)}; }
  };

  static float add(Measure& measure, double value) {
    if (!(std::abs(value) <= 1)) value = value > 1 ? 1 : 0;  // by rounding; what is no number is of a flat cell
    measure.least = std::min(measure.least, value);
    measure.sum += value;
    return static_cast<float>(value);
  }

  /// @returns the cosine of the smallest angle
  double add_angles(const Simplex<D>& s, const Proportions<D>& p) {
    std::array<int, angle_count<D>> bin;
    bool plain = p.good;
    for (std::size_t i = 0; plain && i < p.cosine.size(); ++i) {
      bin[i] = bins_->bin(p.cosine[i]);
      plain = bin[i] >= 0 && p.cosine[i] < most_ - cosine_error && p.cosine[i] > least_ + cosine_error;
    }
    if (!plain) return look(s);
    for (const int b : bin) ++q_.histogram[static_cast<std::size_t>(b / 2)];
    count_smallest(*std::min_element(bin.begin(), bin.end()));
    return *std::max_element(p.cosine.begin(), p.cosine.end());
  }

  double look(const Simplex<D>& s) {
    const auto angles = angles_deg<D>(s);
    for (const double a : angles) ++q_.histogram[static_cast<std::size_t>(CosineBins::bin_of_degrees(a) / 2)];
    const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
    count_smallest(CosineBins::bin_of_degrees(*smallest));
    q_.min_angle_deg = std::min(q_.min_angle_deg, *smallest);
    q_.max_angle_deg = std::max(q_.max_angle_deg, *largest);
    most_ = std::cos(q_.min_angle_deg / degrees);
    least_ = std::cos(q_.max_angle_deg / degrees);
    return std::cos(*smallest / degrees);
  }

  void count_smallest(int bin) {
    const std::size_t last = q_.cells_by_smallest_angle.size() - 1;
    ++q_.cells_by_smallest_angle[std::min(static_cast<std::size_t>(bin), last)];
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
  QualityMeasures q_;
  std::size_t cells_ = 0;
  double most_ratio2_ = 0;
  double most_ = -1, least_ = 1;  ///< of the cosines of the angles that were looked at
  Measure radius_ratio_, scaled_jacobian_;
};

/// By label.
template <int D>
using SumsOfRegions = std::map<double, Sums<D>>;

template <int D>
double label_of(const OutputMesh<D>& mesh, std::size_t cell) {
  return mesh.regions.empty() ? 0.0 : mesh.regions[cell];
}

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
      const double label = label_of(mesh, first + n);
      if (region == sums.end() || region->first != label) region = sums.try_emplace(label).first;
      const CellValues of_cell = region->second.add(simplices[n], {proportions[n / shape_lanes], lane}, radius2,
                                                    shape.shortest_edge_squared[lane], shape.det[lane]);
      for (std::size_t k = 0; k < of_cell.size(); ++k) values[k][first + n] = of_cell[k];
    }
  }
}

/// More than `rank` of the least values, and mostly not many more: those up to a value that a sample suggests.
std::vector<float> low_values(std::span<const float> values, std::size_t rank, const detail::Bulk& bulk) {
  constexpr std::size_t sampled = 1000;
  std::vector<float> low;
  if (const std::size_t step = values.size() / sampled; step > 1) {
    for (std::size_t i = 0; i < values.size(); i += step) low.push_back(values[i]);
    const std::size_t at = std::min(low.size() - 1, rank / step + rank / step / 2 + 5);
    std::nth_element(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(at), low.end());
    const float limit = low[at];
    low = bulk.gather<float>(values.size(), [&](std::size_t i, std::vector<float>& found) {
      if (values[i] <= limit) found.push_back(values[i]);
    });
    if (low.size() > rank) return low;
  }
  low.assign(values.begin(), values.end());
  return low;
}

/// The 1/n-quantiles for the n of `one_in`, which descend: at least one in n values is at most that.
template <std::size_t N>
std::array<double, N> quantiles(std::span<const float> values, const std::array<std::size_t, N>& one_in,
                                const detail::Bulk& bulk) {
  std::array<std::size_t, N> rank;
  for (std::size_t i = 0; i < N; ++i) rank[i] = (values.size() - 1) / one_in[i];
  std::vector<float> low = low_values(values, rank.back(), bulk);
  std::array<double, N> found;
  std::size_t count = low.size();  // that are sure to hold what is looked for
  for (std::size_t i = N; i-- > 0;) {
    const auto at = low.begin() + static_cast<std::ptrdiff_t>(rank[i]);
    std::nth_element(low.begin(), at, low.begin() + static_cast<std::ptrdiff_t>(count));
    found[i] = *at;
    count = rank[i] + 1;
  }
  return found;
}

/// @param values  as ValuesOfCells, of the cells that `q` is about
void set_quantiles(QualityMeasures& q, const std::array<std::span<const float>, 3>& values, const detail::Bulk& bulk) {
  constexpr std::array<std::size_t, 3> one_in{1000, 100, 20};
  const std::array<double, 3> angles = quantiles(values[0], one_in, bulk);
  for (std::size_t i = 0; i < angles.size(); ++i)
    q.smallest_angle_quantiles_deg[i] = std::max(q.min_angle_deg, 2 * std::asin(std::sqrt(angles[i] / 2)) * degrees);
  q.radius_ratio.one_percent = std::max(q.radius_ratio.least, quantiles<1>(values[1], {100}, bulk)[0]);
  q.scaled_jacobian.one_percent = std::max(q.scaled_jacobian.least, quantiles<1>(values[2], {100}, bulk)[0]);
}

/// Puts the values of the cells of each region together, the regions in the order of their labels.
template <int D>
void group(const OutputMesh<D>& mesh, const std::vector<RegionQuality>& regions, const std::vector<std::size_t>& begin,
           ValuesOfCells& values) {
  const auto less = [](const RegionQuality& r, double label) { return r.label < label; };
  std::vector<std::uint32_t> place(mesh.cells.size());
  std::vector<std::size_t> next(begin);
  std::size_t r = 0;
  for (std::size_t c = 0; c < place.size(); ++c) {
    const double label = label_of(mesh, c);
    if (regions[r].label != label)
      r = static_cast<std::size_t>(std::lower_bound(regions.begin(), regions.end(), label, less) - regions.begin());
    place[c] = static_cast<std::uint32_t>(next[r]++);
  }
  std::vector<float> grouped(place.size());
  for (std::vector<float>& v : values) {
    for (std::size_t c = 0; c < place.size(); ++c) grouped[place[c]] = v[c];
    v.swap(grouped);
  }
}

/// @param parts  of which each has the sums of some cells
template <int D>
QualitySummary summarize(const OutputMesh<D>& mesh, const std::vector<SumsOfRegions<D>>& parts, const detail::Bulk& bulk,
                         ValuesOfCells& values) {
  SumsOfRegions<D> by_label;
  for (const SumsOfRegions<D>& part : parts)
    for (const auto& [label, sums] : part) by_label[label].add(sums);
  Sums<D> all;
  QualitySummary summary;
  std::vector<std::size_t> begin{0};
  for (const auto& [label, sums] : by_label) {
    all.add(sums);
    summary.regions.push_back({sums.measures(), label});
    begin.push_back(begin.back() + sums.cells());
  }
  static_cast<QualityMeasures&>(summary) = all.measures();

  if (by_label.size() > 1) group(mesh, summary.regions, begin, values);
  const auto some = [&values](std::size_t from, std::size_t to) {
    std::array<std::span<const float>, 3> spans;
    for (std::size_t k = 0; k < spans.size(); ++k) spans[k] = std::span(values[k]).subspan(from, to - from);
    return spans;
  };
  for (std::size_t r = 0; r < summary.regions.size(); ++r) set_quantiles(summary.regions[r], some(begin[r], begin[r + 1]), bulk);
  if (by_label.size() > 1)
    set_quantiles(summary, some(0, begin.back()), bulk);
  else
    static_cast<QualityMeasures&>(summary) = summary.regions[0];
  return summary;
}

/// summarize_quality().
template <int D>
QualitySummary summary_of(const OutputMesh<D>& mesh) {
  constexpr std::size_t part_size = 1 << 14;
  const std::size_t count = mesh.cells.size(), parts = (count + part_size - 1) / part_size;
  if (count == 0) return {};
  ValuesOfCells values;
  for (std::vector<float>& v : values) v.resize(count);
  std::vector<SumsOfRegions<D>> sums(parts);
  const detail::Bulk bulk(true);
  bulk.parts(parts, [&](std::size_t part) {
    add_cells(mesh, part * part_size, std::min(count, (part + 1) * part_size), sums[part], values);
  });
  return summarize(mesh, sums, bulk, values);
}

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
  return summary_of(mesh);
}

template PGDR_API std::array<double, 3> angles_deg<2>(const Simplex<2>&);
template PGDR_API std::array<double, 6> angles_deg<3>(const Simplex<3>&);
template PGDR_API QualitySummary summarize_quality<2>(const OutputMesh<2>&);
template PGDR_API QualitySummary summarize_quality<3>(const OutputMesh<3>&);

}  // namespace pgdr
