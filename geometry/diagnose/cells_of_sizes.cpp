// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/cells_of_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "diagnose/chance.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {
namespace {

/// Of all cells that gaps ask for, if sizes ask for less, they are not looked at; if so many times as many, gaps are not.
constexpr double worth_while = 0.01;
/// The volume (area) of a cell, of the most that it may be, as meshes of cubes (squares) have them.
constexpr double average_of_most = 0.54, average_of_most_2d = 0.65;

/// Places in the box of an input, one in each box of a grid, and which seed each belongs to: that from which a way leads to it,
/// from place to neighbouring place, past all facets.
template <int D>
class PlacesOfSeeds {
 public:
  static constexpr int a_side = D == 3 ? 12 : 40, count = D == 3 ? 12 * 12 * 12 : 40 * 40;
  static constexpr int no_seed = -1;

  PlacesOfSeeds(const SizeFieldOfGaps<D>& field, const FreeWays<D>& ways)
      : field_(field), ways_(ways), box_(Box<D>::of(field.pieces().points())), seeds_(count, no_seed) {
    Chance chance;
    for (int k = 0; k < count; ++k) {
      Point<D> x;
      for (int i = 0; i < D; ++i) x[i] = box_.low[i] + (coordinate(k, i) + chance()) / a_side * (box_.high[i] - box_.low[i]);
      places_.push_back(x);
    }
  }

  /// Numbers seeds from 0, those of regions and then those of holes.
  void follow_seeds(const StopCheck& stop_check) {
    int number = 0;
    const auto follow = [&](const Point<D>& given) {
      Point<D> x;
      for (int i = 0; i < D; ++i) x[i] = given[i] / field_.pieces().unit();
      follow_from(x, number++, stop_check);
    };
    for (const RegionSeed<D>& region : field_.pieces().domain().regions()) follow(region.point);
    for (const Point<D>& hole : field_.pieces().domain().holes()) follow(hole);
  }

  const Point<D>& place(int k) const { return places_[static_cast<std::size_t>(k)]; }
  int seed(int k) const { return seeds_[static_cast<std::size_t>(k)]; }

 private:
  static int stride(int axis) {
    int step = 1;
    for (int i = 0; i < axis; ++i) step *= a_side;
    return step;
  }
  static int coordinate(int k, int axis) { return k / stride(axis) % a_side; }

  void follow_from(const Point<D>& x, int number, const StopCheck& stop_check) {
    std::vector<int> reached;
    const auto reach = [&](const Point<D>& from, int k) {
      if (seed(k) != no_seed || !ways_.is_free(from, place(k))) return;
      seeds_[static_cast<std::size_t>(k)] = number;
      reached.push_back(k);
    };
    for (int k = 0; k < count; ++k)
      if (is_beside(x, k)) reach(x, k);
    for (std::size_t next = 0; next < reached.size(); ++next) {
      stop_check();
      const int here = reached[next];
      for (int i = 0; i < D; ++i) {
        if (coordinate(here, i) > 0) reach(place(here), here - stride(i));
        if (coordinate(here, i) < a_side - 1) reach(place(here), here + stride(i));
      }
    }
  }
  /// Is x in the box of the grid, or in one beside it?
  bool is_beside(const Point<D>& x, int k) const {
    for (int i = 0; i < D; ++i) {
      const double at = (x[i] - box_.low[i]) / (box_.high[i] - box_.low[i]) * a_side;
      if (!(at > coordinate(k, i) - 1 && at < coordinate(k, i) + 2)) return false;
    }
    return true;
  }

  const SizeFieldOfGaps<D>& field_;
  const FreeWays<D>& ways_;
  const Box<D> box_;
  std::vector<Point<D>> places_;
  std::vector<int> seeds_;
};

template <int D>
double sum_of_places(const SizeFieldOfGaps<D>& field, const FreeWays<D>& ways, const EstimateOptions<D>& options, double of_gaps,
                     const std::function<double(const Point<D>&)>& gap_density, const Bulk& bulk) {
  const auto regions = field.pieces().domain().regions();
  const bool any_in_region = std::ranges::any_of(regions, [](const RegionSeed<D>& r) { return r.size > 0; });
  if (!options.measure && !any_in_region) return 0;
  const StopCheck stop_check(options.stop);
  PlacesOfSeeds<D> places(field, ways);
  if (any_in_region || !regions.empty()) places.follow_seeds(stop_check);
  const auto box = Box<D>::of(field.pieces().points());
  const double unit = field.pieces().unit();
  double volume = 1;
  for (int i = 0; i < D; ++i) volume *= box.high[i] - box.low[i];
  const auto density_at = [&](int k) {
    const int seed = places.seed(k);
    if (seed >= static_cast<int>(regions.size())) return 0.0;  // in a hole
    Point<D> x = places.place(k), given = x;
    for (double& c : given.x) c *= unit;
    double measure = std::numeric_limits<double>::infinity(), label = 0;
    if (seed != PlacesOfSeeds<D>::no_seed) {
      const RegionSeed<D>& region = regions[static_cast<std::size_t>(seed)];
      label = region.attribute;
      if (region.size > 0) measure = region.size * (D == 3 ? average_of_most : average_of_most_2d);
    }
    if (options.measure) measure = std::min(measure, options.measure(given, label));
    const double density = std::pow(unit, D) / measure;
    if (!(density * volume > worth_while * of_gaps) || !ways.is_inside(x)) return 0.0;
    const bool is_most = worth_while * density * volume > of_gaps;
    return is_most ? density : std::max(0.0, density - gap_density(x));
  };
  constexpr int places_a_part = 16;
  std::array<double, PlacesOfSeeds<D>::count> densities{};
  bulk.parts(densities.size() / places_a_part, [&](std::size_t part) {
    const int first = static_cast<int>(part) * places_a_part;
    for (int k = first; k < first + places_a_part; ++k) densities[static_cast<std::size_t>(k)] = density_at(k);
  });
  stop_check();
  return std::accumulate(densities.begin(), densities.end(), 0.0) / PlacesOfSeeds<D>::count * volume;
}

}  // namespace

template <int D>
double cells_of_sizes(const SizeFieldOfGaps<D>& field, const FreeWays<D>& ways, const EstimateOptions<D>& options, double of_gaps,
                      const std::function<double(const Point<D>&)>& gap_density, const Bulk& bulk) {
  return sum_of_places<D>(field, ways, options, of_gaps, gap_density, bulk);
}

template double cells_of_sizes<2>(const SizeFieldOfGaps<2>&, const FreeWays<2>&, const EstimateOptions<2>&, double,
                                  const std::function<double(const Point<2>&)>&, const Bulk&);
template double cells_of_sizes<3>(const SizeFieldOfGaps<3>&, const FreeWays<3>&, const EstimateOptions<3>&, double,
                                  const std::function<double(const Point<3>&)>&, const Bulk&);

}  // namespace pgdr::detail
