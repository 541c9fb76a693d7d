// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/periodic_sides.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "input/words.hpp"
#include "numbers/exact_sum.hpp"
#include "pgdr/error.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

template <int D>
std::string name_of(const PeriodicSides<D>& pair) {
  return std::to_string(pair.from) + " and " + std::to_string(pair.to);
}

template <int D>
constexpr const char* line_word() {
  return D == 2 ? "segment" : "facet";
}

template <int D>
BoxTree<D> tree_of_walls(const SideInput<D>& input) {
  std::vector<Box<D>> boxes;
  for (const auto& wall : input.walls) {
    Box<D> box = Box<D>::empty();
    for (const std::uint32_t v : wall.points) box.add(input.points[v]);
    boxes.push_back(box.widened(input.reach));
  }
  return BoxTree<D>(boxes);
}

/// The inverse of a motion that keeps lengths: its rows are columns. Exact, and rounded once.
template <int D>
Point<D> moved_back(const Motion<D>& m, const Point<D>& p) {
  Point<D> image;
  for (int i = 0; i < D; ++i) {
    ExactSum sum;
    for (int k = 0; k < D; ++k) {
      const double* const row = &m[static_cast<std::size_t>(k * (D + 1))];
      sum.add_product(row[i], p[k]);
      sum.add_product(-row[i], row[D]);
    }
    image[i] = sum.divided_by(1);
  }
  return image;
}

}  // namespace

template <int D>
SideChain<D>::SideChain(const SideInput<D>& input, NearPoints<D>& points, std::vector<PeriodicSides<D>>& pairs)
    : input_(input),
      points_(points),
      places_(input.points, input.reach),
      walls_(tree_of_walls(input)),
      seen_(static_cast<std::uint32_t>(input.points.size())) {
  make_sides(pairs);
  find_motions(pairs);
  order_sides(pairs);
  find_places();
  require_consistent(pairs);
}

template <int D>
void SideChain<D>::make_sides(const std::vector<PeriodicSides<D>>& pairs) {
  for (const auto& pair : pairs) {
    if (pair.from == pair.to) refuse_sides("the periodic sides " + name_of(pair) + " are one side");
    for (const int marker : {pair.from, pair.to})
      if (side_of_.try_emplace(marker, static_cast<std::uint32_t>(sides_.size())).second) sides_.push_back({.marker = marker});
  }
  for (const Side& side : sides_)
    if (!input_.given.contains(side.marker))
      refuse_sides(std::string("no ") + line_word<D>() + " has the marker " + std::to_string(side.marker) +
                   " that a periodic side is to have");
}

template <int D>
void SideChain<D>::find_motions(std::vector<PeriodicSides<D>>& pairs) const {
  const auto points = [&](int marker) {
    std::vector<Point<D>> all;
    for (const std::uint32_t v : input_.given.at(marker)) all.push_back(input_.points[v]);
    return all;
  };
  for (auto& pair : pairs) {
    if (!pair.motion) pair.motion = translation_between<D>(points(pair.from), points(pair.to));
    require_rigid<D>(*pair.motion);
  }
}

/// The first is one that is the image of none, if there is one.
template <int D>
void SideChain<D>::order_sides(const std::vector<PeriodicSides<D>>& pairs) {
  std::set<int> images;
  for (const auto& pair : pairs) images.insert(pair.to);
  std::uint32_t first = 0;
  while (first + 1 < sides_.size() && images.contains(sides_[first].marker)) ++first;
  if (images.contains(sides_[first].marker)) first = 0;
  std::set<std::uint32_t> known{first};
  order_.push_back(first);
  sides_[first].parent = first;
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (const bool forwards : {true, false})
      for (const auto& pair : pairs) {
        const std::uint32_t from = side_of_.at(pair.from), to = side_of_.at(pair.to);
        const std::uint32_t parent = forwards ? from : to, side = forwards ? to : from;
        if (parent != order_[i] || !known.insert(side).second) continue;
        sides_[side].parent = parent;
        sides_[side].motion = *pair.motion;
        sides_[side].is_image = forwards;
        order_.push_back(side);
      }
}

template <int D>
Point<D> SideChain<D>::from_parent(const Side& side, const Point<D>& p) const {
  return side.is_image ? moved<D>(side.motion, p) : moved_back<D>(side.motion, p);
}

template <int D>
Point<D> SideChain<D>::on_first(std::uint32_t side, Point<D> p) const {
  for (std::uint32_t at = side; sides_[at].parent != at; at = sides_[at].parent)
    p = sides_[at].is_image ? moved_back<D>(sides_[at].motion, p) : moved<D>(sides_[at].motion, p);
  return p;
}

template <int D>
Point<D> SideChain<D>::carried(std::uint32_t side, const Point<D>& p) const {
  const Side& s = sides_[side];
  return s.parent == side ? p : from_parent(s, carried(s.parent, p));
}

/// Points of all sides, as they would be on the first; then where they are on the others.
template <int D>
void SideChain<D>::find_places() {
  for (const std::uint32_t s : order_)
    for (const std::uint32_t v : input_.given.at(sides_[s].marker)) {
      const Point<D> p = on_first(s, input_.points[v]);
      if (places_.find(p) == no_entity) add_place(p, v, sides_[s].marker);
    }
  for (const Side& side : sides_)
    if (input_.given.at(side.marker).size() > side.at.size())
      refuse_sides("two points of the periodic side with marker " + std::to_string(side.marker) +
                   " are one within the tolerance");
}

template <int D>
std::uint32_t SideChain<D>::add_place(const Point<D>& p_first, std::uint32_t origin, int marker) {
  const std::uint32_t place = places_.add(p_first);
  for (const std::uint32_t s : order_) {
    Side& side = sides_[s];
    const Point<D> p = side.parent == s ? p_first : from_parent(side, points_[sides_[side.parent].at[place]]);
    std::uint32_t point = points_.find(p);
    const std::uint32_t wall = wall_at(side.marker, point == no_entity ? p : points_[point]);
    if (wall == no_entity) refuse_place(p, side.marker, origin, marker);
    if (point == no_entity) point = points_.add(p);
    side.at.push_back(point);
    side.wall.push_back(wall);
    side.has.insert(point);
  }
  return place;
}

template <int D>
std::uint32_t SideChain<D>::add_place_of(std::uint32_t side, std::uint32_t point) {
  return add_place(on_first(side, points_[point]), point, sides_[side].marker);
}

template <int D>
std::uint32_t SideChain<D>::add_inner_place(const Point<D>& p_first) {
  const std::uint32_t place = places_.add(p_first);
  for (const std::uint32_t s : order_) {
    Side& side = sides_[s];
    const Point<D> p = side.parent == s ? p_first : from_parent(side, points_[sides_[side.parent].at[place]]);
    side.at.push_back(points_.add(p));
    side.wall.push_back(no_entity);
  }
  return place;
}

template <int D>
bool SideChain<D>::take_points() {
  const std::size_t before = first().at.size(),
                    most = 1000 + 100 * input_.points.size();  // more than any group of motions asks for
  for (; seen_ < points_.size(); ++seen_) {
    if (points_.size() > most)
      refuse_sides("the periodic sides contradict each other: there is no end of places that points of the side with marker " +
                   std::to_string(first().marker) + " would be at");
    for (const std::uint32_t s : order_) {
      if (sides_[s].has.contains(seen_) || !is_on(sides_[s], points_[seen_])) continue;
      if (places_.find(on_first(s, points_[seen_])) == no_entity) add_place_of(s, seen_);
    }
  }
  return first().at.size() > before;
}

/// Its place on the side with marker `there` is none. A half of a piece has no origin.
template <int D>
void SideChain<D>::refuse_place(const Point<D>& p, int there, std::uint32_t origin, int marker) const {
  std::string what = "the periodic sides do not match within the tolerance: ";
  const std::vector<std::int64_t> ids = numbers({origin});
  std::vector<std::array<double, 3>> points{in_space(p)};
  if (ids.empty()) {
    what += "a place between two points";
  } else {
    points.insert(points.begin(), in_space(points_[origin]));
    what += "the point " + std::to_string(ids[0]) + ' ' + to_text(points_[origin]) + " of that with marker " +
            std::to_string(marker);
  }
  refuse_sides(what + " would be at " + to_text(p) + " of that with marker " + std::to_string(there) + ", where there is no " +
                   line_word<D>() + " of it",
               ids, points);
}

template <int D>
std::uint32_t SideChain<D>::wall_at(int marker, const Point<D>& p) const {
  std::uint32_t found = no_entity;
  walls_.at(p, [&](std::uint32_t w) {
    const auto& wall = input_.walls[w];
    if (wall.marker != marker || w >= found) return;
    std::array<Point<D>, D> corners;
    for (std::size_t i = 0; i < D; ++i) corners[i] = input_.points[wall.points[i]];
    if (closest_to_simplex<D>(p, corners).square <= input_.reach * input_.reach) found = w;
  });
  return found;
}

/// As the input counts; of those that are its.
template <int D>
std::vector<std::int64_t> SideChain<D>::numbers(std::initializer_list<std::uint32_t> points) const {
  std::vector<std::int64_t> ids;
  for (const std::uint32_t v : points)
    if (v < input_.numbers.size()) ids.push_back(input_.numbers[v]);
  return ids;
}

template <int D>
void SideChain<D>::require_consistent(const std::vector<PeriodicSides<D>>& pairs) const {
  for (const auto& pair : pairs) {
    const Side &from = sides_[side_of_.at(pair.from)], &to = sides_[side_of_.at(pair.to)];
    for (std::uint32_t k = 0; k < from.at.size(); ++k) {
      const Point<D>&p = point(from, k), &q = point(to, k), image = moved<D>(*pair.motion, p);
      if (squared_distance(image, q) <= input_.reach * input_.reach) continue;
      refuse_sides("the periodic sides " + name_of(pair) + " contradict the others: the point " + to_text(p) + " would be at " +
                       to_text(image) + " and at " + to_text(q),
                   numbers({from.at[k], to.at[k]}), {in_space(p), in_space(image), in_space(q)});
    }
  }
}

template <int D>
auto SideChain<D>::pieces_on(const Side& side) const -> std::set<Piece> {
  std::vector<Box<D>> boxes;
  for (const std::uint32_t v : side.at) boxes.push_back(Box<D>::around(points_[v]));
  const BoxTree<D> tree(boxes);
  std::set<Piece> pieces;
  for (const auto& line : input_.lines) {
    if (line.marker != side.marker) continue;
    const Point<D>&a = input_.points[line.points[0]], &b = input_.points[line.points[1]];
    std::vector<std::pair<double, std::uint32_t>> along;
    tree.meeting(box_of_edge<D>(a, b, input_.reach), [&](std::uint32_t k) {
      if (const auto t = part_near<D>(points_[side.at[k]], a, b, input_.reach)) along.emplace_back(*t, k);
    });
    std::ranges::sort(along);
    for (std::size_t i = 1; i < along.size(); ++i) {
      const std::uint32_t k = along[i - 1].second, l = along[i].second;
      pieces.insert({std::min(k, l), std::max(k, l)});
    }
  }
  return pieces;
}

template <int D>
void SideChain<D>::require_like(const std::set<Piece>& pieces, const Side& side) const {
  const std::set<Piece> others = pieces_on(side);
  std::vector<Piece> unlike;
  std::ranges::set_symmetric_difference(pieces, others, std::back_inserter(unlike));
  if (unlike.empty()) return;
  const auto [a, b] = unlike.front();
  refuse_sides("the periodic sides with markers " + std::to_string(first().marker) + " and " + std::to_string(side.marker) +
                   " do not match: one of them alone has a segment between " + to_text(point(first(), a)) + " and " +
                   to_text(point(first(), b)) + ", on the other " + to_text(point(side, a)) + " and " + to_text(point(side, b)),
               numbers({first().at[a], first().at[b], side.at[a], side.at[b]}),
               {in_space(point(first(), a)), in_space(point(first(), b)), in_space(point(side, a)), in_space(point(side, b))});
}

template <int D>
void SideChain<D>::find_pieces() {
  std::set<Piece> pieces = pieces_on(first());
  for (const std::uint32_t s : order_) {
    if (D == 2)
      require_like(pieces, sides_[s]);
    else
      pieces.merge(pieces_on(sides_[s]));
  }
  pieces_.assign(pieces.begin(), pieces.end());
}

template <int D>
std::vector<PeriodicSides<D>> make_chains(const SideInput<D>& input, NearPoints<D>& points,
                                          std::span<const PeriodicSides<D>> sides, std::vector<SideChain<D>>& chains) {
  std::map<int, std::uint32_t> number;
  for (const auto& pair : sides)
    for (const int marker : {pair.from, pair.to}) number.try_emplace(marker, static_cast<std::uint32_t>(number.size()));
  DisjointSets sets(number.size());
  for (const auto& pair : sides) sets.unite(number[pair.from], number[pair.to]);
  std::map<std::uint32_t, std::vector<PeriodicSides<D>>> pairs_of;
  for (const auto& pair : sides) pairs_of[sets.find(number[pair.from])].push_back(pair);
  std::vector<PeriodicSides<D>> all;
  for (auto& [set, pairs] : pairs_of) {
    chains.emplace_back(input, points, pairs);
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  for (bool any = true; any;) {
    any = false;
    for (SideChain<D>& chain : chains) any = chain.take_points() || any;
  }
  return all;
}

#define PGDR_INSTANTIATE(D)                                                                                                     \
  template class SideChain<D>;                                                                                                  \
  template std::vector<PeriodicSides<D>> make_chains<D>(const SideInput<D>&, NearPoints<D>&, std::span<const PeriodicSides<D>>, \
                                                        std::vector<SideChain<D>>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
