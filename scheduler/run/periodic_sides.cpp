// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/periodic_sides.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "input/words.hpp"
#include "join/near_tests.hpp"
#include "pgdr/error.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::vector<std::int64_t>& ids = {},
                         const std::vector<std::array<double, 3>>& points = {}) {
  throw UsageError({Errc::bad_option, what, {}, 0, ids, points});
}

/// How far along an edge a point is that lies on it, or is an end, within so much.
std::optional<double> part_near(const Point2& p, const Point2& a, const Point2& b, double width) {
  if (squared_distance(p, a) <= width * width) return 0;
  if (squared_distance(p, b) <= width * width) return 1;
  return part_of_edge_near<2>(p, a, b, width);
}

Box<2> box_of(const Point2& a, const Point2& b, double width) {
  Box<2> box = Box<2>::around(a);
  box.add(b);
  return box.widened(width);
}

std::string name_of(const PeriodicSides<2>& pair) { return std::to_string(pair.from) + " and " + std::to_string(pair.to); }

}  // namespace

SideChain::SideChain(const Plc<2>& plc, std::vector<PeriodicSides<2>>& pairs, double tolerance)
    : plc_(plc), reach_(2 * tolerance) {
  make_sides(pairs);
  find_given_points();
  find_motions(pairs);
  order_sides(pairs);
  find_places();
  require_consistent(pairs);
  find_pieces();
}

void SideChain::make_sides(const std::vector<PeriodicSides<2>>& pairs) {
  for (const auto& pair : pairs) {
    if (pair.from == pair.to) refuse("the periodic sides " + name_of(pair) + " are one side");
    for (const int marker : {pair.from, pair.to})
      if (side_of_.try_emplace(marker, static_cast<std::uint32_t>(sides_.size())).second) sides_.push_back({.marker = marker});
  }
}

/// Ends of its segments, and points that lie on these.
void SideChain::find_given_points() {
  std::vector<Box<2>> boxes;
  std::vector<std::uint32_t> segments;
  for (std::uint32_t s = 0; s < plc_.segments.size(); ++s) {
    if (!has(plc_.segments[s].marker)) continue;
    const auto& [a, b] = plc_.segments[s].points;
    boxes.push_back(box_of(plc_.points[a], plc_.points[b], reach_));
    segments.push_back(s);
  }
  const BoxTree<2> tree(boxes);
  std::set<std::pair<std::uint32_t, std::array<double, 2>>> seen;
  for (std::uint32_t v = 0; v < plc_.points.size(); ++v)
    tree.at(plc_.points[v], [&](std::uint32_t k) {
      const auto& s = plc_.segments[segments[k]];
      const std::uint32_t side = side_of_.at(s.marker);
      const Point2& p = plc_.points[v];
      if (!part_near(p, plc_.points[s.points[0]], plc_.points[s.points[1]], reach_)) return;
      if (seen.emplace(side, std::array{p[0] + 0.0, p[1] + 0.0}).second) sides_[side].given.push_back(v);
    });
  for (Side& side : sides_) {
    std::ranges::sort(side.given);
    if (side.given.empty())
      refuse("no segment has the marker " + std::to_string(side.marker) + " that a periodic side is to have");
  }
}

void SideChain::find_motions(std::vector<PeriodicSides<2>>& pairs) const {
  const auto points = [&](int marker) {
    std::vector<Point2> all;
    for (const std::uint32_t v : sides_[side_of_.at(marker)].given) all.push_back(plc_.points[v]);
    return all;
  };
  for (auto& pair : pairs) {
    if (!pair.motion) pair.motion = translation_between<2>(points(pair.from), points(pair.to));
    require_rigid<2>(*pair.motion);
  }
}

/// The first is one that is the image of none, if there is one.
void SideChain::order_sides(const std::vector<PeriodicSides<2>>& pairs) {
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

/// The inverse of a motion that keeps lengths: its rows are columns.
Point2 moved_back(const Motion<2>& m, const Point2& p) {
  const double x = p[0] - m[2], y = p[1] - m[5];
  return {{m[0] * x + m[3] * y, m[1] * x + m[4] * y}};
}

Point2 SideChain::from_parent(const Side& side, const Point2& p) const {
  return side.is_image ? moved<2>(side.motion, p) : moved_back(side.motion, p);
}
Point2 SideChain::to_parent(const Side& side, const Point2& p) const {
  return side.is_image ? moved_back(side.motion, p) : moved<2>(side.motion, p);
}

/// Points of all sides, as they would be on the first; then where they are on the others.
void SideChain::find_places() {
  std::vector<Point2> on_first;
  const auto is_new = [&](const Point2& p) {
    return std::ranges::none_of(on_first, [&](const Point2& x) { return squared_distance(x, p) <= reach_ * reach_; });
  };
  for (const std::uint32_t s : order_)
    for (const std::uint32_t v : sides_[s].given) {
      Point2 p = plc_.points[v];
      for (std::uint32_t at = s; sides_[at].parent != at; at = sides_[at].parent) p = to_parent(sides_[at], p);
      if (!is_new(p)) continue;
      on_first.push_back(p);
      add_place(p, v, sides_[s].marker);
    }
  for (const Side& side : sides_)
    if (side.given.size() > side.at.size())
      refuse("two points of the periodic side with marker " + std::to_string(side.marker) + " are one within the tolerance");
}

/// Where the input has a point within the tolerance, that is the place.
std::uint32_t SideChain::add_place(const Point2& on_first, std::uint32_t origin, int marker) {
  const auto place = static_cast<std::uint32_t>(sides_[order_[0]].at.size());
  for (const std::uint32_t s : order_) {
    Side& side = sides_[s];
    Point2 p = side.parent == s ? on_first : from_parent(side, sides_[side.parent].at[place]);
    const auto is_here = [&](std::uint32_t v) { return squared_distance(plc_.points[v], p) <= reach_ * reach_; };
    const auto point = std::ranges::find_if(side.given, is_here);
    if (point != side.given.end()) p = plc_.points[*point];
    const std::uint32_t segment = segment_at(side.marker, p);
    if (segment == no_entity) refuse_place(p, side.marker, origin, marker);
    side.at.push_back(p);
    side.point.push_back(point == side.given.end() ? no_entity : *point);
    side.segment.push_back(segment);
  }
  return place;
}

/// Its place on the side with marker `there` is none. A half of a piece has no origin.
void SideChain::refuse_place(const Point2& p, int there, std::uint32_t origin, int marker) const {
  std::string what = "the periodic sides do not match within the tolerance: ";
  std::vector<std::int64_t> ids;
  std::vector<std::array<double, 3>> points{in_space(p)};
  if (origin == no_entity) {
    what += "a place between two points";
  } else {
    ids.push_back(std::int64_t{origin} + plc_.first_index);
    points.insert(points.begin(), in_space(plc_.points[origin]));
    what += "the point " + std::to_string(ids[0]) + ' ' + to_text(plc_.points[origin]) + " of that with marker " +
            std::to_string(marker);
  }
  refuse(
      what + " would be at " + to_text(p) + " of that with marker " + std::to_string(there) + ", where there is no segment of it",
      ids, points);
}

std::uint32_t SideChain::segment_at(int marker, const Point2& p) const {
  for (std::uint32_t s = 0; s < plc_.segments.size(); ++s) {
    const auto& [ends, its] = plc_.segments[s];
    if (its == marker && part_near(p, plc_.points[ends[0]], plc_.points[ends[1]], reach_)) return s;
  }
  return no_entity;
}

/// As the input counts; of those that are its.
std::vector<std::int64_t> SideChain::numbers(std::initializer_list<std::uint32_t> points) const {
  std::vector<std::int64_t> ids;
  for (const std::uint32_t v : points)
    if (v != no_entity) ids.push_back(std::int64_t{v} + plc_.first_index);
  return ids;
}

void SideChain::require_consistent(const std::vector<PeriodicSides<2>>& pairs) const {
  for (const auto& pair : pairs) {
    const Side &from = sides_[side_of_.at(pair.from)], &to = sides_[side_of_.at(pair.to)];
    for (std::size_t k = 0; k < from.at.size(); ++k) {
      const Point2 image = moved<2>(*pair.motion, from.at[k]);
      if (squared_distance(image, to.at[k]) <= reach_ * reach_) continue;
      refuse("the periodic sides " + name_of(pair) + " contradict the others: the point " + to_text(from.at[k]) +
                 " would be at " + to_text(image) + " and at " + to_text(to.at[k]),
             numbers({from.point[k], to.point[k]}), {in_space(from.at[k]), in_space(image), in_space(to.at[k])});
    }
  }
}

std::vector<SideChain::Piece> SideChain::pieces_on(const Side& side) const {
  std::set<Piece> pieces;
  for (const auto& segment : plc_.segments) {
    if (segment.marker != side.marker) continue;
    const Point2 &a = plc_.points[segment.points[0]], &b = plc_.points[segment.points[1]];
    std::vector<std::pair<double, std::uint32_t>> along;
    for (std::uint32_t k = 0; k < side.at.size(); ++k)
      if (const auto t = part_near(side.at[k], a, b, reach_)) along.emplace_back(*t, k);
    std::ranges::sort(along);
    for (std::size_t i = 1; i < along.size(); ++i) {
      const std::uint32_t k = along[i - 1].second, l = along[i].second;
      pieces.insert({std::min(k, l), std::max(k, l)});
    }
  }
  return {pieces.begin(), pieces.end()};
}

void SideChain::find_pieces() {
  const Side& first = sides_[order_[0]];
  pieces_ = pieces_on(first);
  for (const std::uint32_t s : order_) {
    const Side& side = sides_[s];
    std::vector<Piece> unlike;
    std::ranges::set_symmetric_difference(pieces_, pieces_on(side), std::back_inserter(unlike));
    if (unlike.empty()) continue;
    const auto [a, b] = unlike.front();
    refuse("the periodic sides with markers " + std::to_string(first.marker) + " and " + std::to_string(side.marker) +
               " do not match: one of them alone has a segment between " + to_text(first.at[a]) + " and " + to_text(first.at[b]) +
               ", on the other " + to_text(side.at[a]) + " and " + to_text(side.at[b]),
           numbers({first.point[a], first.point[b], side.point[a], side.point[b]}),
           {in_space(first.at[a]), in_space(first.at[b]), in_space(side.at[a]), in_space(side.at[b])});
  }
}

std::vector<std::vector<SideChain::Part>> SideChain::parts_of_pieces(const OutputMesh<2>& mesh) const {
  std::vector<std::vector<Part>> parts(pieces_.size());
  for (const Side& side : sides_) {
    std::vector<Box<2>> boxes;
    for (const auto& [a, b] : pieces_) boxes.push_back(box_of(side.at[a], side.at[b], reach_));
    const BoxTree<2> tree(boxes);
    for (const auto& s : mesh.subsegments) {
      if (s.marker != side.marker) continue;
      const Point2 &p = mesh.points[s.vertices[0]], &q = mesh.points[s.vertices[1]];
      tree.meeting(box_of(p, q, 0), [&](std::uint32_t k) {
        const Point2 &a = side.at[pieces_[k][0]], &b = side.at[pieces_[k][1]];
        const auto t = part_near(p, a, b, reach_), u = part_near(q, a, b, reach_);
        if (t && u && *t != *u) parts[k].push_back({std::min(*t, *u), std::max(*t, *u), std::sqrt(squared_distance(p, q))});
      });
    }
  }
  return parts;
}

/// Halves the part of a piece from one number to another until no part of the mesh there is shorter.
void SideChain::halve(const Piece& ends, double from, double to, const std::vector<Part>& parts, const Piece& whole,
                      std::vector<Piece>& made) {
  constexpr double rounding = 1 + 0x1p-20;  // of what is as long, but for the ulps of its ends
  const Side& first = sides_[order_[0]];
  const Point2 a = first.at[whole[0]], b = first.at[whole[1]];
  const double length = (to - from) * std::sqrt(squared_distance(a, b)), slack = (to - from) * 0x1p-20;
  const bool is_short = std::ranges::all_of(parts, [&](const Part& part) {
    return part.to <= from + slack || part.from >= to - slack || length <= part.length * rounding;
  });
  if (is_short) return made.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1])});
  const double t = (from + to) / 2;
  const std::uint32_t middle = add_place({{(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]}}, no_entity, 0);
  halve({ends[0], middle}, from, t, parts, whole, made);
  halve({middle, ends[1]}, t, to, parts, whole, made);
}

bool SideChain::divide(const OutputMesh<2>& mesh) {
  const std::size_t before = pieces_.size();
  const std::vector<std::vector<Part>> parts = parts_of_pieces(mesh);
  std::vector<Piece> made;
  for (std::size_t k = 0; k < before; ++k) halve(pieces_[k], 0, 1, parts[k], pieces_[k], made);
  pieces_ = std::move(made);
  return pieces_.size() > before;
}

void SideChain::add_to(Plc<2>& plc) const {
  const std::size_t given = plc_.points.size(), columns = given == 0 ? 0 : plc_.point_attributes.size() / given;
  for (const std::uint32_t s : order_) {
    const Side& side = sides_[s];
    std::vector<std::uint32_t> number(side.point);
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (number[k] != no_entity) continue;
      number[k] = static_cast<std::uint32_t>(plc.points.size());
      plc.points.push_back(side.at[k]);
      if (!plc_.point_markers.empty()) plc.point_markers.push_back(side.marker);
      const auto [a, b] = plc_.segments[side.segment[k]].points;
      const double t = part_near(side.at[k], plc_.points[a], plc_.points[b], reach_).value_or(0);
      for (std::size_t i = 0; i < columns; ++i)
        plc.point_attributes.push_back((1 - t) * plc_.point_attributes[a * columns + i] +
                                       t * plc_.point_attributes[b * columns + i]);
    }
    for (const auto& [a, b] : pieces_) plc.segments.push_back({{number[a], number[b]}, side.marker});
  }
}

}  // namespace pgdr::detail
