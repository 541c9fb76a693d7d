// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The least number of cells. Three things need some, each alone: gaps (cells_between.hpp), the walls, and sizes. Walls are unions
// of faces of cells, and have no fewer of these than triangles (2D: segments) now, as all their points become vertices; a cell
// has D + 1 faces. Sizes need the integral of one over the largest cell that they allow: of each volume its measure, which the
// signed pyramids (2D: triangles) over its walls add up to, times the mean over places in it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "diagnose/cells_between.hpp"
#include "diagnose/meshed_space.hpp"
#include "diagnose/near_pieces.hpp"
#include "numbers/signed_measure.hpp"
#include "pgdr/estimate.hpp"
#include "space/chance.hpp"
#include "space/stop_check.hpp"

namespace pgdr {
namespace {

using detail::Box;
using detail::MeshedSpace;
using detail::NearPieces;

/// Places at which a function of sizes is asked, one in each box of a grid about all: a twelfth of its side (2D: a fortieth) is
/// the finest that they see of it.
template <int D>
constexpr int places_a_side = D == 3 ? 12 : 40;
template <int D>
constexpr std::size_t count_places = D == 3 ? 12 * 12 * 12 : 40 * 40;

/// What is meshed, by its volumes; in unit scale.
template <int D>
class MeasuredSpace {
 public:
  MeasuredSpace(const NearPieces<D>& pieces, const MeshedSpace<D>& space)
      : space_(space),
        box_(Box<D>::of(pieces.points())),
        middle_(detail::on_edge(box_.low, box_.high, 0.5)),
        measures_(space.volumes().size()) {
    constexpr double parts = D == 2 ? 2 : 6;
    for (std::uint32_t wall = 0; wall < space.hits().count(); ++wall) {
      // From the wall to the middle of all; positive if that is on its positive side.
      const double pyramid = detail::signed_measure<D>(space.hits().corners(wall), middle_).first / parts;
      for (const bool negative : {false, true}) {
        const auto& volume = space.volume_beside(wall, negative);
        faces_ += volume.meshed ? 1 : 0;
        measures_[number(volume)] += (negative ? -1 : 1) * pyramid;
      }
    }
  }

  /// On sides of walls that are meshed.
  double faces() const { return static_cast<double>(faces_); }

  /// The integral of density(x, volume) over what is meshed.
  template <class Density>
  double integral(const Density& density, const detail::Bulk& bulk, const detail::StopCheck& stop_check) const {
    std::vector<Mean> means(measures_.size());
    const auto note = [&](const Seen& seen) {
      if (seen.volume) means[number(*seen.volume)].add(seen.density);
    };
    const auto look = [&](const Point<D>& x, const Volume* volume) {
      return volume && volume->meshed ? Seen{volume, density(x, *volume)} : Seen{};
    };
    const std::vector<Point<D>> places = choose_places();
    std::vector<Seen> seen(places.size());
    constexpr std::size_t places_a_part = 16;
    bulk.parts(seen.size() / places_a_part, [&](std::size_t part) {
      for (std::size_t k = part * places_a_part; k < (part + 1) * places_a_part; ++k)
        seen[k] = look(places[k], space_.volume_at(places[k]));
    });
    stop_check();
    for (const Seen& s : seen) note(s);
    // A volume in which there is no place is thin, or small: what is at its walls is near to all of it.
    std::vector<char> is_missed(means.size());
    for (std::size_t v = 0; v < means.size(); ++v) is_missed[v] = means[v].count == 0 ? 1 : 0;
    for (std::uint32_t wall = 0; wall < space_.hits().count(); ++wall)
      for (const bool negative : {false, true}) {
        const Volume& volume = space_.volume_beside(wall, negative);
        if (is_missed[number(volume)] && means[number(volume)].count < count_places<D>) note(look(middle_of(wall), &volume));
      }
    double sum = 0;
    for (std::size_t v = 0; v < means.size(); ++v)
      if (means[v].count > 0) sum += std::max(measures_[v], 0.0) * means[v].value();
    return sum;
  }

 private:
  using Volume = typename MeshedSpace<D>::Volume;
  struct Seen {
    const Volume* volume = nullptr;
    double density = 0;
  };
  struct Mean {
    double sum = 0;
    std::size_t count = 0;
    void add(double x) { sum += x, ++count; }
    double value() const { return sum / static_cast<double>(count); }
  };

  std::size_t number(const Volume& volume) const { return static_cast<std::size_t>(&volume - space_.volumes().data()); }
  Point<D> middle_of(std::uint32_t wall) const {
    Point<D> middle{};
    for (const Point<D>& x : space_.hits().corners(wall))
      for (int i = 0; i < D; ++i) middle[i] += x[i] / D;
    return middle;
  }
  std::vector<Point<D>> choose_places() const {
    detail::Chance chance;
    std::vector<Point<D>> places(count_places<D>);
    for (std::size_t k = 0; k < places.size(); ++k) {
      int rest = static_cast<int>(k);
      for (int i = 0; i < D; ++i, rest /= places_a_side<D>)
        places[k][i] = box_.low[i] + (rest % places_a_side<D> + chance()) / places_a_side<D> * (box_.high[i] - box_.low[i]);
    }
    return places;
  }

  const MeshedSpace<D>& space_;
  const Box<D> box_;
  const Point<D> middle_;
  std::uint64_t faces_ = 0;
  std::vector<double> measures_;  ///< volumes (areas), by number
};

/// Cells that sizes need; 0 if nothing bounds them.
template <int D>
double cells_of_sizes(const NearPieces<D>& pieces, const MeasuredSpace<D>& space, const EstimateOptions<D>& options,
                      const detail::Bulk& bulk) {
  const auto has_size = [](const RegionSeed<D>& r) { return r.size > 0; };
  if (!options.measure && std::ranges::none_of(pieces.domain().regions(), has_size)) return 0;
  const double unit = pieces.unit();
  const auto density = [&](Point<D> x, const typename MeshedSpace<D>::Volume& volume) {
    for (double& c : x.x) c *= unit;
    double most = volume.size;
    if (options.measure) most = std::min(most, options.measure(x, volume.label));
    return std::pow(unit, D) / most;
  };
  return space.integral(density, bulk, detail::StopCheck(options.stop));
}

}  // namespace

template <int D>
CellEstimate<D> estimate_cells(const Domain<D>& domain, const EstimateOptions<D>& options) {
  const detail::Bulk bulk(true, options.stop);
  const detail::StopCheck stop_check(options.stop);
  const NearPieces<D> pieces(domain, bulk);
  const MeshedSpace<D> space(pieces, options.voids_by_nesting, bulk, stop_check);
  stop_check();
  CellEstimate<D> estimate;
  detail::add_cells_between<D>(pieces, space, options.radius_edge_bound, bulk, estimate);
  stop_check();
  const MeasuredSpace<D> measured(pieces, space);
  const double at_walls = measured.faces() / (D + 1), of_sizes = cells_of_sizes<D>(pieces, measured, options, bulk);
  estimate.cells = std::max({1.0, at_walls, of_sizes, estimate.at_least});
  return estimate;
}

template PGDR_API CellEstimate<2> estimate_cells<2>(const Domain<2>&, const EstimateOptions<2>&);
template PGDR_API CellEstimate<3> estimate_cells<3>(const Domain<3>&, const EstimateOptions<3>&);

}  // namespace pgdr
