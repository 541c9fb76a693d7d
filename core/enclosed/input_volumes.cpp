// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds InputVolumes: walls, sides joined round ridges and along lines, seeds, measures.
#include "enclosed/input_volumes.hpp"

#include <algorithm>
#include <cmath>

#include "numbers/rounding.hpp"
#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"
#include "space/turn_round.hpp"

namespace pgdr::checking {

using detail::DisjointSets;

void CompensatedSum::add(double x) {
  const double t = sum_ + x;
  rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
  sum_ = t;
  absolute_ += std::abs(x);
}

namespace {

/// A wall at a ridge: `ahead` is its side that a turn round the ridge, counter-clockwise seen against the direction
/// from the ridge's smaller point to its larger (in 2D: in the plane), enters when it leaves the wall.
struct AtRidge {
  std::array<std::uint32_t, 2> ridge;  ///< sorted; the second is 0 in 2D
  std::uint32_t simplex, apex;
  bool ahead_negative;
};

}  // namespace

template <int D>
class InputBuilder {
 public:
  explicit InputBuilder(InputVolumes<D>& out) : out_(out), walls_(out.walls_), sides_(0), components_(0) {}

  void run(RegionMode mode) {
    collect_walls();
    out_.plant_simplices();
    collect_ridges();
    const auto n = static_cast<std::uint32_t>(walls_.simplices.size());
    sides_ = DisjointSets(2 * n + 1);  // side 2 i: positive, 2 i + 1: negative, 2 n: outside
    components_ = DisjointSets(n);
    for (std::size_t i = 0, j; i < ridges_.size(); i = j) {
      for (j = i + 1; j < ridges_.size() && ridges_[j].ridge == ridges_[i].ridge;) ++j;
      turn_round(std::span(ridges_).subspan(i, j - i));
    }
    cast_lines();
    number_volumes();
    place_seeds();
    if (mode == RegionMode::automatic) out_.nest();
    if (numbers_volumes(mode)) out_.number();
    measure();
  }

 private:
  void collect_walls() {
    const detail::Box<D> box = detail::Box<D>::of(walls_.points);
    out_.span_ = std::max(out_.span_, box.longest_side());
    for (int k = 0; k < D; ++k) centre_[k] = box.low[k] + (box.high[k] - box.low[k]) / 2;
    if constexpr (D == 3) {
      for (std::uint32_t s = 0; s < walls_.segments.size(); ++s) {
        auto key = walls_.segments[s];
        std::sort(key.begin(), key.end());
        segments_.push_back({key, s});
      }
      std::sort(segments_.begin(), segments_.end());
    }
  }

  void collect_ridges() {
    for (std::uint32_t i = 0; i < walls_.simplices.size(); ++i) {
      const auto& s = walls_.simplices[i];
      for (int k = 0; k < D; ++k) {
        if constexpr (D == 2) {
          ridges_.push_back({{s[k], 0}, i, s[1 - k], k == 1});
        } else {
          const std::uint32_t a = s[(k + 1) % 3], b = s[(k + 2) % 3];
          ridges_.push_back({{std::min(a, b), std::max(a, b)}, i, s[k], a > b});
        }
      }
    }
    std::sort(ridges_.begin(), ridges_.end(),
              [](const AtRidge& x, const AtRidge& y) { return x.ridge != y.ridge ? x.ridge < y.ridge : x.simplex < y.simplex; });
  }

  Sign turn(const std::array<std::uint32_t, 2>& ridge, std::uint32_t from, std::uint32_t to) const {
    const auto& p = walls_.points;
    if constexpr (D == 2)
      return orient2d(p[ridge[0]], p[from], p[to]);
    else
      return orient3d(p[ridge[0]], p[ridge[1]], p[from], p[to]);
  }

  void turn_round(std::span<AtRidge> walls) {
    detail::sort_round(walls, [&, ridge = walls[0].ridge](std::uint32_t v, std::uint32_t w) { return turn(ridge, v, w); });
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const AtRidge &w = walls[i], &next = walls[(i + 1) % walls.size()];
      sides_.unite(2 * w.simplex + w.ahead_negative, 2 * next.simplex + !next.ahead_negative);
      components_.unite(w.simplex, next.simplex);
    }
    if constexpr (D == 3) note_segment(walls);
  }

  void note_segment(std::span<const AtRidge> walls) {
    const auto at = std::lower_bound(segments_.begin(), segments_.end(), std::pair{walls[0].ridge, std::uint32_t{0}});
    if (at == segments_.end() || at->first != walls[0].ridge) return;
    for (const AtRidge& w : walls) out_.at_segments_.push_back({at->second, w.simplex});
  }

  /// Along a line, what lies between two walls that follow each other is one volume; both its ends are outside.
  void cast_lines() {
    const auto n = static_cast<std::uint32_t>(walls_.simplices.size());
    std::vector<std::uint8_t> linked(n, 0);
    std::vector<std::uint32_t> first_of_component;
    for (std::uint32_t i = 0; i < n; ++i)
      if (components_.find(i) == i) first_of_component.push_back(i);
    for (const std::uint32_t root : first_of_component)
      for (std::uint64_t attempt = 0; !linked[root]; ++attempt) {
        if (attempt == 1000) throw InputError({Errc::entities_intersect, "Two walls of the input overlap.", {}, 0, {}, {}});
        cast_line(target(root, attempt), attempt, linked);
      }
  }

  /// The centroid of a wall of the component; of another one at each attempt.
  Point<D> target(std::uint32_t root, std::uint64_t attempt) {
    const auto n = static_cast<std::uint32_t>(walls_.simplices.size());
    auto i = static_cast<std::uint32_t>((root + 7919 * attempt) % n);
    while (components_.find(i) != root) i = (i + 1) % n;
    const auto s = out_.simplex(i);
    Point<D> c;
    for (int k = 0; k < D; ++k) {
      double sum = 0;
      for (const Point<D>& x : s) sum += x[k] / D;
      c[k] = sum;
    }
    return c;
  }

  void cast_line(const Point<D>& through, std::uint64_t attempt, std::vector<std::uint8_t>& linked) {
    const Point<D> q = out_.far_from(through, attempt);
    Point<D> p;
    for (int k = 0; k < D; ++k) p[k] = through[k] + (through[k] - q[k]);
    const auto hits = out_.crossings(q, p);
    if (!hits || hits->empty()) return;
    std::uint32_t open = 2 * static_cast<std::uint32_t>(walls_.simplices.size());
    for (const std::uint32_t i : *hits) {
      const bool from_negative = side_of(i, q) == Sign::negative;
      sides_.unite(open, 2 * i + from_negative);
      open = 2 * i + !from_negative;
      linked[components_.find(i)] = 1;
    }
    sides_.unite(open, 2 * static_cast<std::uint32_t>(walls_.simplices.size()));
  }

  Sign side_of(std::uint32_t i, const Point<D>& x) const {
    const auto s = out_.simplex(i);
    if constexpr (D == 2)
      return orient2d(s[0], s[1], x);
    else
      return orient3d(s[0], s[1], s[2], x);
  }

  void number_volumes() {
    const auto n = static_cast<std::uint32_t>(walls_.simplices.size());
    std::vector<std::uint32_t> volume_of(2 * n + 1, 0xffffffffu);
    const auto volume_at = [&](std::uint32_t side) {
      auto& v = volume_of[sides_.find(side)];
      if (v == 0xffffffffu) {
        v = static_cast<std::uint32_t>(out_.volumes_.size());
        out_.volumes_.emplace_back();
      }
      return v;
    };
    volume_at(2 * n);
    out_.volumes_[0].kept = false;
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t positive = volume_at(2 * i);
      out_.sides_.push_back({positive, volume_at(2 * i + 1)});
    }
  }

  void place_seeds() {
    for (const auto& p : walls_.holes)
      if (const auto v = out_.locate(p)) out_.volumes_[*v].kept = false;
    for (std::uint32_t i = 0; i < walls_.regions.size(); ++i) {
      const RegionSeed<D>& seed = walls_.regions[i];
      out_.region_volumes_.push_back(out_.locate(seed.point));
      if (const auto v = out_.region_volumes_.back()) {
        out_.volumes_[*v].seeds.push_back(i);
        if (seed.size > 0) out_.volumes_[*v].size = std::min(out_.volumes_[*v].size, seed.size);
      }
    }
  }

  void measure() {
    constexpr double parts = D == 2 ? 2 : 6;
    std::vector<CompensatedSum> sum(out_.volumes_.size());
    for (std::uint32_t i = 0; i < walls_.simplices.size(); ++i) {
      const auto [value, error] = signed_measure<D>(out_.simplex(i), centre_);
      const auto& side = out_.sides_[i];
      if (side[0] == side[1]) continue;
      sum[side[0]].add(value / parts);
      sum[side[1]].add(-value / parts);
      for (const std::uint32_t v : side) out_.volumes_[v].measure_error += error / parts;
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
      out_.volumes_[v].measure = sum[v].value();
      out_.volumes_[v].measure_error += sum[v].error();
    }
  }

  InputVolumes<D>& out_;
  VolumeWalls<D>& walls_;
  Point<D> centre_;
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> segments_;
  std::vector<AtRidge> ridges_;
  DisjointSets sides_, components_;
};

template <int D>
InputVolumes<D>::InputVolumes(VolumeWalls<D> walls, RegionMode mode) : walls_(std::move(walls)) {
  InputBuilder<D>(*this).run(mode);
}

template class InputVolumes<2>;
template class InputVolumes<3>;

}  // namespace pgdr::checking
