// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "given/cover.hpp"
#include "given/volumes.hpp"
#include "numbers/vectors.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

template <int D>
class MeasureChecker {
 public:
  MeasureChecker(const GivenTask<D>& task, const GivenMatch<D>& match, const InputVolumes<D>& volumes)
      : task_(task), input_(task.input), match_(match), volumes_(volumes), of_volume_(volumes.volumes().size()) {
    const auto box = detail::Box<D>::of(input_.plc().points);
    for (int k = 0; k < D; ++k) centre_[k] = box.low[k] + (box.high[k] - box.low[k]) / 2;
  }

  void run() {
    look_at_walls();
    look_at_given();
    close_volumes();
    for (std::uint32_t v = 0; v < of_volume_.size(); ++v)
      if (volumes_.volumes()[v].kept && of_volume_[v].known) compare(v);
  }

 private:
  using Corners = std::array<std::uint32_t, D>;
  struct OfVolume {
    bool known = true;
    CompensatedSum measure;
    double slack = 0;
  };
  /// A ridge of a given simplex, as the boundary of a volume runs along it.
  struct Ridge {
    std::uint32_t volume;
    std::array<std::uint32_t, D - 1> corners;
    int times;
    friend auto operator<=>(const Ridge&, const Ridge&) = default;
  };

  Corners given(std::uint32_t g) const {
    if constexpr (D == 2)
      return input_.segments()[g].points;
    else
      return input_.triangles()[g].points;
  }
  std::uint32_t volume(std::uint32_t wall, bool negative) const { return volumes_.volumes_of(wall)[negative]; }

  /// A volume is known if all walls about it lie on something given.
  void look_at_walls() {
    const std::size_t count = walls(task_.mesh).size();
    std::vector<double> reach(count, -1);
    for (const OnGiven& on : match_.on_given) reach[on.wall] = std::max(reach[on.wall], match_.reach[on.given]);
    for (std::uint32_t w = 0; w < count; ++w) {
      if (volume(w, false) == volume(w, true)) continue;
      for (const bool negative : {false, true}) {
        OfVolume& of = of_volume_[volume(w, negative)];
        if (reach[w] < 0) of.known = false;
        of.slack += slack(volumes_.simplex(w), reach[w]);
      }
    }
  }

  /// What a wall sweeps that moves by at most r.
  static double slack(const std::array<Point<D>, D>& s, double r) {
    const auto u = detail::difference(s[1], s[0]);
    if constexpr (D == 2) {
      return r * std::sqrt(detail::dot(u, u)) + r * r;
    } else {
      const auto v = detail::difference(s[2], s[0]), w = detail::difference(s[2], s[1]), n = detail::cross(u, v);
      const double perimeter = std::sqrt(detail::dot(u, u)) + std::sqrt(detail::dot(v, v)) + std::sqrt(detail::dot(w, w));
      return r * std::sqrt(detail::dot(n, n)) / 2 + r * r * perimeter;
    }
  }

  using Walls = std::vector<OnGiven>;

  /// What walls say of the two sides of each given simplex, or of each part of one that shares walls with others.
  void look_at_given() {
    find_shared();
    const auto& list = match_.on_given;
    for (std::size_t i = 0, j; i < list.size(); i = j) {
      for (j = i + 1; j < list.size() && list[j].given == list[i].given;) ++j;
      const Walls on(list.begin() + static_cast<std::ptrdiff_t>(i), list.begin() + static_cast<std::ptrdiff_t>(j));
      const std::uint32_t g = on[0].given;
      if (std::ranges::none_of(on, [&](const OnGiven& w) { return shared_[w.wall]; }))
        look_at(given(g), on, 0);
      else if constexpr (D == 2)
        look_at_parts(g, on);
      else
        look_at_overlap(g, on);
    }
  }

  /// `reach`: how far points beside it may be corners.
  void look_at(const Corners& corners, const Walls& on, double reach) {
    std::array<std::uint32_t, 2> sides{};
    std::array<bool, 2> mixed{};
    for (const bool negative : {false, true}) {
      sides[negative] = volume(on[0].wall, on[0].turned != negative);
      for (const OnGiven& w : on) mixed[negative] |= volume(w.wall, w.turned != negative) != sides[negative];
      if (mixed[negative]) forget(on, negative);
    }
    if (sides[0] != sides[1] || mixed[0] || mixed[1]) add(corners, sides, reach);
  }

  void forget(const Walls& on, bool negative) {
    for (const OnGiven& w : on) of_volume_[volume(w.wall, w.turned != negative)].known = false;
  }

  /// Walls on several given items, but for those so thin that neighbours in a plane have them in common.
  void find_shared() {
    const auto item = [&](std::uint32_t g) {
      if constexpr (D == 2)
        return g;
      else
        return input_.triangles()[g].facet;
    };
    std::vector<std::uint32_t>& owner = owner_;
    owner.assign(walls(task_.mesh).size(), none);
    shared_.assign(owner.size(), 0);
    for (const OnGiven& on : match_.on_given) {
      const std::uint32_t i = item(on.given);
      if (owner[on.wall] != none && owner[on.wall] != i)
        shared_[on.wall] |= D == 2 || width(volumes_.simplex(on.wall)) > 2 * match_.reach[on.given];
      owner[on.wall] = std::min(owner[on.wall], i);
    }
  }

  /// Cut at the given points on it, as those that share its walls are. Each part counts once.
  void look_at_parts(std::uint32_t g, const Walls& on) requires(D == 2) {
    const std::array<Point<D>, 2> ends{input_.point(given(g)[0]), input_.point(given(g)[1])};
    const auto d = detail::difference(ends[1], ends[0]);
    const auto along = [&](const Point<D>& x) { return detail::dot(detail::difference(x, ends[0]), d); };
    std::vector<std::pair<double, OnGiven>> placed;
    for (const OnGiven& w : on) {
      const auto s = volumes_.simplex(w.wall);
      placed.push_back({along(s[0]) / 2 + along(s[1]) / 2, w});
    }
    std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto points = points_along(g, ends, along);
    auto next = placed.begin();
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      Walls of_part;
      for (; next != placed.end() && next->first <= points[k + 1].first; ++next) of_part.push_back(next->second);
      const double centre = points[k].first / 2 + points[k + 1].first / 2;
      for (auto w = next == placed.begin() ? next : next - 1; of_part.empty() && w != placed.end() && w <= next; ++w) {
        const auto s = volumes_.simplex(w->second.wall);  // it is longer than the part
        const auto [low, high] = std::minmax({along(s[0]), along(s[1])});
        if (centre >= low && centre <= high) of_part.push_back(w->second);
      }
      const Corners corners{points[k].second, points[k + 1].second};
      if (!of_part.empty() && parts_.insert(std::minmax({corners[0], corners[1]})).second)
        look_at(corners, of_part, match_.reach[g]);
    }
  }

  template <class Along>
  std::vector<std::pair<double, std::uint32_t>> points_along(std::uint32_t g, const std::array<Point<D>, 2>& ends,
                                                             const Along& along) {
    std::vector<std::pair<double, std::uint32_t>> points;
    given_points().meeting(detail::Box<D>::of(ends).widened(match_.reach[g]), [&](std::uint32_t p) {
      if (is_near<D>(input_.point(p), ends, match_.reach[g])) points.push_back({along(input_.point(p)), input_.place(p)});
    });
    detail::make_set(points);
    return points;
  }

  /// The first of several facets that have the same walls counts. What facets of others have in part is left open.
  void look_at_overlap(std::uint32_t g, const Walls& on) requires(D == 3) {
    const std::uint32_t facet = input_.triangles()[g].facet;
    const auto is_others = [&](const OnGiven& w) { return shared_[w.wall] && owner_[w.wall] != facet; };
    if (std::ranges::none_of(on, is_others)) return look_at(given(g), on, 0);
    if (std::ranges::all_of(on, [&](const OnGiven& w) { return is_others(w) || is_thin(g, w.wall); })) return;
    forget(on, false);
    forget(on, true);
  }

  bool is_thin(std::uint32_t g, std::uint32_t wall) const { return width(volumes_.simplex(wall)) <= 2 * match_.reach[g]; }
  /// Twice its area over its longest edge.
  static double width(const std::array<Point3, 3>& s) {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, squared_distance(s[k], s[(k + 1) % 3]));
    const auto n = detail::cross(detail::difference(s[1], s[0]), detail::difference(s[2], s[0]));
    return std::sqrt(detail::dot(n, n) / longest);
  }
  static double width(const std::array<Point2, 2>& s) { return std::sqrt(squared_distance(s[0], s[1])); }

  const detail::BoxTree<D>& given_points() {
    if (!given_points_) {
      std::vector<detail::Box<D>> boxes;
      for (const Point<D>& p : input_.plc().points) boxes.push_back(detail::Box<D>::around(p));
      given_points_ = std::make_unique<detail::BoxTree<D>>(boxes);
    }
    return *given_points_;
  }

  void add(const Corners& corners, const std::array<std::uint32_t, 2>& sides, double reach) {
    constexpr double parts = D == 2 ? 2 : 6;
    std::array<Point<D>, D> simplex;
    for (int k = 0; k < D; ++k) simplex[k] = input_.point(corners[k]);
    const auto [value, error] = signed_measure<D>(simplex, centre_);
    for (const bool negative : {false, true}) {
      OfVolume& of = of_volume_[sides[negative]];
      of.measure.add((negative ? -value : value) / parts);
      of.slack += error / parts;
      of.slack += slack(simplex, reach);
      const int sense = negative ? -1 : 1;
      for (int k = 0; k < D; ++k) {
        if constexpr (D == 2) {
          ridges_.push_back({sides[negative], {corners[k]}, k == 0 ? -sense : sense});
        } else {
          const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
          ridges_.push_back({sides[negative], {std::min(a, b), std::max(a, b)}, a < b ? sense : -sense});
        }
      }
    }
  }

  void close_volumes() {
    std::sort(ridges_.begin(), ridges_.end());
    for (std::size_t i = 0, j; i < ridges_.size(); i = j) {
      int times = ridges_[i].times;
      for (j = i + 1; j < ridges_.size() && ridges_[j].volume == ridges_[i].volume && ridges_[j].corners == ridges_[i].corners;
           ++j)
        times += ridges_[j].times;
      if (times != 0) of_volume_[ridges_[i].volume].known = false;
    }
  }

  void compare(std::uint32_t v) {
    const double given = of_volume_[v].measure.value(), meshed = volumes_.volumes()[v].measure;
    const double slack = of_volume_[v].slack + of_volume_[v].measure.error() + volumes_.volumes()[v].measure_error;
    if (std::abs(given - meshed) <= slack) return;
    task_.findings.add(Kind::wrong_volume, {v}, [&] {
      return "A volume measures " + words(meshed) + " in the mesh, and " + words(given) + " between the " +
             (D == 2 ? "segments" : "facets") + " of the input; they may differ by " + words(slack) + ".";
    });
  }

  const GivenTask<D>& task_;
  const GivenInput<D>& input_;
  const GivenMatch<D>& match_;
  const InputVolumes<D>& volumes_;
  std::vector<OfVolume> of_volume_;
  std::vector<Ridge> ridges_;
  std::vector<std::uint32_t> owner_;                         ///< of each wall: the first given item that it is on
  std::vector<std::uint8_t> shared_;                         ///< it is on several
  std::set<std::pair<std::uint32_t, std::uint32_t>> parts_;  ///< 2D: by their ends
  std::unique_ptr<detail::BoxTree<D>> given_points_;
  Point<D> centre_;
};

}  // namespace

template <int D>
void check_given_measures(const GivenTask<D>& task, const GivenMatch<D>& match, const InputVolumes<D>& volumes) {
  MeasureChecker<D>(task, match, volumes).run();
}

template void check_given_measures(const GivenTask<2>&, const GivenMatch<2>&, const InputVolumes<2>&);
template void check_given_measures(const GivenTask<3>&, const GivenMatch<3>&, const InputVolumes<3>&);

}  // namespace pgdr::checking
