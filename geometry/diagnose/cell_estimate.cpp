// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How many cells there will be: the integral of one over the volume of a cell at x, over all x inside. A cell at x is up to a
// regular simplex with edges of h(x) (size_field_of_gaps.hpp), or as large as sizes ask for. The integral of the former is taken
// over the leaves of a tree that halves boxes until they are as small as h at their centres. Of these there may be as many as
// cells; so only some hundred paths from the root are followed. At each node they are shared between the two halves in proportion
// to what these look like, and what a leaf has is divided by the share that got there. So the mean of the estimate is the whole
// sum, whatever the shares are; the better they are, the nearer to the mean is one estimate.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "diagnose/cells_between.hpp"
#include "diagnose/cells_of_sizes.hpp"
#include "diagnose/chance.hpp"
#include "diagnose/size_field_of_gaps.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/estimate.hpp"
#include "space/stop_check.hpp"

namespace pgdr {
namespace {

using detail::Box;
using detail::Chance;
using detail::SizeFieldOfGaps;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Simplices in a unit of volume (area) where none may have longer edges than 1: regular ones would be 6 sqrt 2 (2D: 4 / sqrt 3),
/// but on the average they are not as large as they may be, 0.54 (0.65) of it in meshes of cubes (squares).
template <int D>
constexpr double simplices_a_unit = D == 3 ? 8.48528137423857 / 0.54 : 2.309401076758503 / 0.65;

template <int D>
Point<D> center_of(const Box<D>& box) {
  Point<D> c;
  for (int i = 0; i < D; ++i) c[i] = box.low[i] / 2 + box.high[i] / 2;
  return c;
}
template <int D>
double volume_of(const Box<D>& box) {
  double v = 1;
  for (int i = 0; i < D; ++i) v *= box.high[i] - box.low[i];
  return v;
}

constexpr double least_size = 0x1p-52;  // in unit scale: nothing is nearer but what meets

/// Cells in a unit of volume (area), where edges are as long as h.
template <int D>
double density_of(double h) {
  return simplices_a_unit<D> / std::pow(std::max(h, least_size), D);
}

/// The integral of what gaps ask for. Used once.
template <int D>
class PathsThroughTree {
 public:
  PathsThroughTree(const SizeFieldOfGaps<D>& field, const detail::Bulk& bulk, const std::stop_token& stop)
      : field_(field), bulk_(bulk), stop_check_(stop) {}

  /// The middle one of some estimates: one that has found what others have missed may be far above the mean.
  double cells() {
    const auto p = field_.pieces().points();
    const auto box = Box<D>::of(p);
    if (!(volume_of(box) > 0)) return 0;
    constexpr double least = 48, most = 256, pieces_a_path = 1000;
    const double paths = std::floor(std::clamp(static_cast<double>(p.size()) / pieces_a_path, least, most));
    order_.resize(p.size());
    std::iota(order_.begin(), order_.end(), 0u);
    Estimates estimates = follow(look_at(box, 0, p.size()), paths);
    std::sort(estimates.begin(), estimates.end());
    return estimates[1];
  }

 private:
  struct Node {
    Box<D> box;
    std::size_t first, last;  ///< its points in order_
    double cells;             ///< if all of it is as at its centre
    double forecast;          ///< with what seems to be in it
    bool is_leaf;
  };
  using Estimates = std::array<double, 3>;
  /// Those of all estimates that go through a node. The part of the paths that gets there is the same for all.
  struct Paths {
    Node node;
    Estimates count;
    double share;
    bool any() const { return count != Estimates{}; }
  };
  /// What is below a node: its halves, or the cells of a leaf.
  struct Below {
    Node first, second;
    double cells;
  };

  /// All paths together, from level to level, so that the nodes of one are looked at side by side, each once.
  Estimates follow(const Node& root, double paths) {
    Estimates sums{};
    std::vector<Paths> level{{root, {paths, paths, paths}, 1}}, next;
    while (!level.empty()) {
      std::vector<Below> below(level.size());
      bulk_.parts(level.size(), [&](std::size_t i) { below[i] = look_below(level[i].node); });
      stop_check_();
      next.clear();
      for (std::size_t i = 0; i < level.size(); ++i) {
        const Paths& here = level[i];
        for (std::size_t e = 0; here.node.is_leaf && e < sums.size(); ++e)
          sums[e] += here.count[e] / (paths * here.share) * below[i].cells;
        if (!here.node.is_leaf) share_out(here, below[i], next);
      }
      level.swap(next);
    }
    return sums;
  }

  Below look_below(const Node& node) {
    if (node.is_leaf) return {{}, {}, node.cells * part_meshed(node.box)};
    const auto [first, second] = halves(node);
    return {first, second, 0};
  }

  /// How much of the box is meshed, by the middles of its quarters (3D: eighths).
  double part_meshed(const Box<D>& box) const {
    constexpr int places = 1 << D;
    int meshed = 0;
    for (int k = 0; k < places; ++k) {
      Point<D> x;
      for (int i = 0; i < D; ++i) x[i] = box.low[i] + ((k >> i & 1) != 0 ? 0.75 : 0.25) * (box.high[i] - box.low[i]);
      meshed += field_.space().is_meshed(x) ? 1 : 0;
    }
    return static_cast<double>(meshed) / places;
  }

  void share_out(const Paths& here, const Below& below, std::vector<Paths>& next) {
    const Node &a = below.first, &b = below.second;
    const auto part_of = [](double mine, double other) { return mine / (mine + other); };
    // Mostly by the forecast; not by it alone, as there may be nothing of what it has seen.
    constexpr double trust = 7.0 / 8;
    const double part = (1 - trust) * part_of(a.cells, b.cells) + trust * part_of(a.forecast, b.forecast);
    Paths to_a{a, {}, here.share * part}, to_b{b, {}, here.share * (1 - part)};
    for (std::size_t e = 0; e < here.count.size(); ++e) {
      if (here.count[e] == 0) continue;
      to_a.count[e] = std::floor(here.count[e] * part + chance_());
      to_b.count[e] = here.count[e] - to_a.count[e];
    }
    for (const Paths& to : {to_a, to_b})
      if (to.any()) next.push_back(to);
  }

  Node look_at(const Box<D>& box, std::size_t first, std::size_t last) const {
    constexpr double unit = simplices_a_unit<D>;
    const Point<D> x = center_of(box);
    const auto look = field_.look(x);
    const double width = box.longest_side();
    Node node{box, first, last, density_of<D>(look.h) * volume_of(box), 0, !(width > std::max(look.h, least_size))};
    node.forecast = node.cells + unit * static_cast<double>(last - first) + layer(box, x, look.nearest);
    const auto& [off, gap, place] = look.on_segment;
    if (off < width && box.meets(Box<D>::around(place)))
      node.forecast += unit * width / std::max(gap, least_size);  // along an edge
    return node;
  }
  /// The cells of a layer along the plane (line) that has this place nearest to the middle of the box: none if that misses the
  /// box.
  static double layer(const Box<D>& box, const Point<D>& middle, const typename SizeFieldOfGaps<D>::Narrow& narrow) {
    if (!(narrow.gap < infinity)) return 0;
    double reach = 0;  // of the box, at right angles to the plane
    for (int i = 0; i < D; ++i) {
      const double slope = narrow.distance > 0 ? std::fabs(middle[i] - narrow.place[i]) / narrow.distance : 1.0 / D;
      reach += slope * (box.high[i] - box.low[i]) / 2;
    }
    const double off = narrow.distance / reach;
    if (!(off < 1)) return 0;
    constexpr double mean = 1.5;  // of 1 over that of 1 - off^2, as the part of the plane in the box falls off to its corners
    const double part = mean * (1 - off * off) * volume_of(box) / (2 * reach);
    return simplices_a_unit<D> / (D - 1) * part / std::pow(std::max(narrow.gap, least_size), D - 1);
  }
  std::pair<Node, Node> halves(const Node& node) {
    const Box<D>& box = node.box;
    int axis = 0;
    for (int i = 1; i < D; ++i)
      if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
    Box<D> low = box, high = box;
    const double middle = low.high[axis] = high.low[axis] = center_of(box)[axis];
    const auto p = field_.pieces().points();
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto split = std::partition(at(node.first), at(node.last), [&](std::uint32_t v) { return p[v][axis] < middle; });
    const auto second = static_cast<std::size_t>(split - order_.begin());
    return {look_at(low, node.first, second), look_at(high, second, node.last)};
  }

  const SizeFieldOfGaps<D>& field_;
  const detail::Bulk& bulk_;
  const detail::StopCheck stop_check_;
  Chance chance_;
  std::vector<std::uint32_t> order_;  ///< points, those of each node together
};

}  // namespace

template <int D>
CellEstimate<D> estimate_cells(const Domain<D>& domain, const EstimateOptions<D>& options) {
  const detail::Bulk bulk(true, options.stop);
  const detail::StopCheck stop_check(options.stop);
  const SizeFieldOfGaps<D> field(domain, options, bulk);
  stop_check();
  CellEstimate<D> estimate;
  detail::add_cells_between<D>(field, options.radius_edge_bound, bulk, estimate);
  stop_check();
  estimate.cells = PathsThroughTree<D>(field, bulk, options.stop).cells();
  const auto density = [&](const Point<D>& x) { return density_of<D>(field.look(x).h); };
  estimate.cells += detail::cells_of_sizes<D>(field, options, estimate.cells, density, bulk);
  estimate.cells = std::max({estimate.cells, estimate.at_least, 1.0});
  return estimate;
}

template PGDR_API CellEstimate<2> estimate_cells<2>(const Domain<2>&, const EstimateOptions<2>&);
template PGDR_API CellEstimate<3> estimate_cells<3>(const Domain<3>&, const EstimateOptions<3>&);

}  // namespace pgdr
