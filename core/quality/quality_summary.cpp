// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The summary of a mesh that one process has, and of one that several have: quantiles of what quality.cpp measures.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "pgdr/quality.hpp"
#include "quality/quality_of_part.hpp"

namespace pgdr {
namespace {

using detail::CountsOfRegion;
using detail::MeasuredCells;
using detail::ValuesOfCells;

constexpr std::array<std::size_t, 3> angles_one_in{1000, 100, 20};
constexpr std::array<std::size_t, 1> others_one_in{100};

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

/// Quantiles of ValuesOfCells.
struct Quantiles {
  std::array<double, 3> angles;
  double radius_ratio, scaled_jacobian;
};

void set_quantiles(QualityMeasures& q, const Quantiles& found) {
  constexpr double degrees = 180 / std::numbers::pi;
  for (std::size_t i = 0; i < found.angles.size(); ++i)
    q.smallest_angle_quantiles_deg[i] = std::max(q.min_angle_deg, 2 * std::asin(std::sqrt(found.angles[i] / 2)) * degrees);
  q.radius_ratio.one_percent = std::max(q.radius_ratio.least, found.radius_ratio);
  q.scaled_jacobian.one_percent = std::max(q.scaled_jacobian.least, found.scaled_jacobian);
}

/// Of the values from `first` to `last`.
Quantiles quantiles_of(const ValuesOfCells& values, std::size_t first, std::size_t last, const detail::Bulk& bulk) {
  const auto some = [&](std::size_t measure) { return std::span(values[measure]).subspan(first, last - first); };
  return {quantiles(some(0), angles_one_in, bulk), quantiles(some(1), others_one_in, bulk)[0],
          quantiles(some(2), others_one_in, bulk)[0]};
}

/// Puts the values of the cells of each region together, the regions in the order of their labels.
/// @param label_of  the label of a cell
/// @param regions  of these cells, or of more
/// @returns where the values of each region begin, and where those of the last one end
template <class LabelOf>
std::vector<std::size_t> group(const LabelOf& label_of, const std::vector<CountsOfRegion>& regions, ValuesOfCells& values) {
  const auto less = [](const CountsOfRegion& r, double label) { return r.label < label; };
  std::vector<std::uint32_t> place(values[0].size());
  std::vector<std::size_t> begin(regions.size() + 1), next;
  std::size_t r = 0;
  for (std::size_t c = 0; c < place.size(); ++c) {
    const double label = label_of(c);
    if (regions[r].label != label)
      r = static_cast<std::size_t>(std::lower_bound(regions.begin(), regions.end(), label, less) - regions.begin());
    place[c] = static_cast<std::uint32_t>(r);
    ++begin[r + 1];
  }
  for (std::size_t i = 0; i < regions.size(); ++i) begin[i + 1] += begin[i];
  next = begin;
  for (std::uint32_t& p : place) p = static_cast<std::uint32_t>(next[p]++);
  std::vector<float> grouped(place.size());
  for (std::vector<float>& v : values) {
    for (std::size_t c = 0; c < place.size(); ++c) grouped[place[c]] = v[c];
    v.swap(grouped);
  }
  return begin;
}

/// Without quantiles. @pre there are cells
QualitySummary summary_of(const std::vector<CountsOfRegion>& regions) {
  QualitySummary summary;
  detail::QualityCounts all;
  for (const auto& [label, counts] : regions) {
    all.add(counts);
    summary.regions.push_back({counts.measures(), label});
  }
  static_cast<QualityMeasures&>(summary) = all.measures();
  return summary;
}

/// In the order of the values. Zero has one sign.
std::uint32_t bits_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

double value_of(std::uint32_t bits) { return std::bit_cast<float>(bits >> 31 ? bits & 0x7fffffffu : ~bits); }

constexpr int bits_per_round = 8;
static_assert(bits_per_round * detail::QualityOfPart::rounds == 32);
constexpr std::size_t digits = std::size_t{1} << bits_per_round;

int shift_of(int round) { return 32 - bits_per_round * (round + 1); }

}  // namespace

namespace detail {

template <int D>
QualityOfPart QualityOfPart::of(const OutputMesh<D>& cells) {
  MeasuredCells measured = measure_cells(cells, Bulk(true));
  QualityOfPart part;
  part.own_ = std::move(measured.regions);
  part.values_ = std::move(measured.values);
  part.labels_ = cells.regions;
  part.labels_.resize(cells.cells.size());
  return part;
}

/// The sets are the regions, and after them, if there are several, all cells.
void QualityOfPart::take(const std::vector<CountsOfRegion>& all) {
  all_ = joined(all);
  const std::vector<std::size_t> begin = group([this](std::size_t c) { return labels_[c]; }, all_, values_);
  std::vector<double>().swap(labels_);
  std::uint64_t cells = 0;
  for (std::size_t r = 0; r < all_.size(); ++r) {
    add_quantiles(begin[r], begin[r + 1], all_[r].counts.cells);
    cells += all_[r].counts.cells;
  }
  if (all_.size() > 1) add_quantiles(0, begin.back(), cells);
}

void QualityOfPart::add_quantiles(std::size_t first, std::size_t last, std::uint64_t cells) {
  for (const std::size_t n : angles_one_in) quantiles_.push_back({first, last, 0, (cells - 1) / n});
  for (const std::size_t measure : {1, 2}) quantiles_.push_back({first, last, measure, (cells - 1) / others_one_in[0]});
}

std::vector<std::uint64_t> QualityOfPart::counts(int round) const {
  const int shift = shift_of(round);
  std::vector<std::uint64_t> counts(quantiles_.size() * digits);
  for (std::size_t i = 0; i < quantiles_.size(); ++i) {
    const Quantile& q = quantiles_[i];
    for (std::size_t v = q.first; v < q.last; ++v) {
      const std::uint32_t beyond = bits_of(values_[q.measure][v]) ^ q.known;
      if (const std::uint32_t digit = beyond >> shift; digit < digits) ++counts[i * digits + digit];
    }
  }
  return counts;
}

void QualityOfPart::narrow(int round, const std::vector<std::uint64_t>& sums) {
  for (std::size_t i = 0; i < quantiles_.size(); ++i) {
    Quantile& q = quantiles_[i];
    std::uint32_t digit = 0;
    while (q.rank >= sums[i * digits + digit]) q.rank -= sums[i * digits + digit++];
    q.known |= digit << shift_of(round);
  }
}

void QualityOfPart::set_quantiles(QualityMeasures& q, std::size_t set) const {
  const auto value = [&](std::size_t i) { return value_of(quantiles_[5 * set + i].known); };
  pgdr::set_quantiles(q, {{value(0), value(1), value(2)}, value(3), value(4)});
}

QualitySummary QualityOfPart::summary() const {
  if (all_.empty()) return {};
  QualitySummary summary = summary_of(all_);
  for (std::size_t r = 0; r < all_.size(); ++r) set_quantiles(summary.regions[r], r);
  set_quantiles(summary, all_.size() > 1 ? all_.size() : 0);
  return summary;
}

template QualityOfPart QualityOfPart::of<2>(const OutputMesh<2>&);
template QualityOfPart QualityOfPart::of<3>(const OutputMesh<3>&);

}  // namespace detail

template <int D>
QualitySummary summarize_quality(const OutputMesh<D>& mesh) {
  if (mesh.cells.empty()) return {};
  const detail::Bulk bulk(true);
  auto [regions, values] = detail::measure_cells(mesh, bulk);
  QualitySummary summary = summary_of(regions);
  if (regions.size() > 1) {
    const auto begin = group([&mesh](std::size_t c) { return detail::label_of(mesh, c); }, regions, values);
    for (std::size_t r = 0; r < regions.size(); ++r)
      set_quantiles(summary.regions[r], quantiles_of(values, begin[r], begin[r + 1], bulk));
  }
  const Quantiles all = quantiles_of(values, 0, mesh.cells.size(), bulk);
  set_quantiles(summary, all);
  if (regions.size() == 1) set_quantiles(summary.regions[0], all);
  return summary;
}

template PGDR_API QualitySummary summarize_quality<2>(const OutputMesh<2>&);
template PGDR_API QualitySummary summarize_quality<3>(const OutputMesh<3>&);

}  // namespace pgdr
