// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/cells_of_sizes.hpp"

#include <algorithm>
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

/// One place in each box of a grid.
template <int D>
constexpr int places_a_side = D == 3 ? 12 : 40;
template <int D>
constexpr int count_places = D == 3 ? 12 * 12 * 12 : 40 * 40;

template <int D>
std::vector<Point<D>> places_in(const Box<D>& box) {
  Chance chance;
  std::vector<Point<D>> places;
  for (int k = 0; k < count_places<D>; ++k) {
    Point<D> x;
    for (int i = 0, rest = k; i < D; ++i, rest /= places_a_side<D>)
      x[i] = box.low[i] + (rest % places_a_side<D> + chance()) / places_a_side<D> * (box.high[i] - box.low[i]);
    places.push_back(x);
  }
  return places;
}

}  // namespace

template <int D>
double cells_of_sizes(const SizeFieldOfGaps<D>& field, const EstimateOptions<D>& options, double of_gaps,
                      const std::function<double(const Point<D>&)>& gap_density, const Bulk& bulk) {
  const auto regions = field.pieces().domain().regions();
  if (!options.measure && std::ranges::none_of(regions, [](const RegionSeed<D>& r) { return r.size > 0; })) return 0;
  const auto box = Box<D>::of(field.pieces().points());
  const std::vector<Point<D>> places = places_in<D>(box);
  const double unit = field.pieces().unit();
  double volume = 1;
  for (int i = 0; i < D; ++i) volume *= box.high[i] - box.low[i];
  const auto density_at = [&](const Point<D>& x) {
    const auto* const here = field.space().volume_at(x);
    if (!here || !here->meshed) return 0.0;
    Point<D> given = x;
    for (double& c : given.x) c *= unit;
    double measure = here->size * (D == 3 ? average_of_most : average_of_most_2d);
    if (options.measure) measure = std::min(measure, options.measure(given, here->label));
    const double density = std::pow(unit, D) / measure;
    if (!(density * volume > worth_while * of_gaps)) return 0.0;
    const bool is_most = worth_while * density * volume > of_gaps;
    return is_most ? density : std::max(0.0, density - gap_density(x));
  };
  constexpr std::size_t places_a_part = 16;
  std::vector<double> densities(places.size());
  bulk.parts(densities.size() / places_a_part, [&](std::size_t part) {
    const std::size_t first = part * places_a_part;
    for (std::size_t k = first; k < first + places_a_part; ++k) densities[k] = density_at(places[k]);
  });
  StopCheck(options.stop)();
  return std::accumulate(densities.begin(), densities.end(), 0.0) / count_places<D> * volume;
}

template double cells_of_sizes<2>(const SizeFieldOfGaps<2>&, const EstimateOptions<2>&, double,
                                  const std::function<double(const Point<2>&)>&, const Bulk&);
template double cells_of_sizes<3>(const SizeFieldOfGaps<3>&, const EstimateOptions<3>&, double,
                                  const std::function<double(const Point<3>&)>&, const Bulk&);

}  // namespace pgdr::detail
