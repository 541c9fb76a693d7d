// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include "check/given/volumes.hpp"
#include "numbers/vectors.hpp"
#include "space/box.hpp"

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
  std::uint32_t volume(std::uint32_t wall, bool negative) const { return volumes_.patches()[wall].volume[negative]; }

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

  /// What walls say of the two sides of each given simplex. Those of the same corners count once.
  void look_at_given() {
    std::set<Corners> seen;
    const auto& list = match_.on_given;
    for (std::size_t i = 0, j; i < list.size(); i = j) {
      for (j = i + 1; j < list.size() && list[j].given == list[i].given;) ++j;
      Corners key = given(list[i].given);
      for (std::uint32_t& p : key) p = input_.place(p);
      const Corners corners = key;
      std::sort(key.begin(), key.end());
      if (!seen.insert(key).second) continue;
      std::array<std::uint32_t, 2> sides{};
      std::array<bool, 2> mixed{};
      for (const bool negative : {false, true}) {
        sides[negative] = volume(list[i].wall, list[i].turned != negative);
        for (std::size_t k = i + 1; k < j; ++k)
          mixed[negative] |= volume(list[k].wall, list[k].turned != negative) != sides[negative];
        for (std::size_t k = i; k < j && mixed[negative]; ++k)
          of_volume_[volume(list[k].wall, list[k].turned != negative)].known = false;
      }
      if (sides[0] != sides[1] || mixed[0] || mixed[1]) add(corners, sides);
    }
  }

  void add(const Corners& corners, const std::array<std::uint32_t, 2>& sides) {
    constexpr double parts = D == 2 ? 2 : 6;
    std::array<Point<D>, D> simplex;
    for (int k = 0; k < D; ++k) simplex[k] = input_.point(corners[k]);
    const auto [value, error] = signed_measure<D>(simplex, centre_);
    for (const bool negative : {false, true}) {
      OfVolume& of = of_volume_[sides[negative]];
      of.measure.add((negative ? -value : value) / parts);
      of.slack += error / parts;
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
