// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/gift_wrap.hpp"

#include <algorithm>

#include "numbers/side_of_plane.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using Face = GiftWrap::Face;

constexpr int inner_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

Face smallest_first(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

}  // namespace

Face GiftWrap::face_of(const Cell& cell, int i) {
  return smallest_first({cell[inner_faces[i][0]], cell[inner_faces[i][1]], cell[inner_faces[i][2]]});
}

bool GiftWrap::fill(std::span<const Point3> points, std::span<const Face> front, std::size_t most_cells,
                    const std::function<bool()>& ended) {
  points_ = points;
  cells_.clear();
  front_.clear();
  for (const Face& f : front) add_to_front(smallest_first(f));
  while (!front_.empty())
    if (cells_.size() >= most_cells || (ended && ended()) || !wrap(Face(front_.back().vertices))) return false;
  return true;
}

template <std::size_t N>
detail::Box<3> GiftWrap::box_of(const std::array<Index, N>& corners) const {
  std::array<Point3, N> points;
  for (std::size_t i = 0; i < N; ++i) points[i] = points_[corners[i]];
  return detail::Box<3>::of(points);
}

void GiftWrap::add_to_front(const Face& f) { front_.push_back({f, box_of(f)}); }

/// Puts a cell on the face, which leaves the front. Of the candidates the first is the one whose sphere with the face has no
/// other inside on the face's positive side.
bool GiftWrap::wrap(const Face& f) {
  find_candidates(f);
  const auto later = [&](Index v, Index w) {
    const Simplex<3> s{points_[f[0]], points_[f[1]], points_[f[2]], points_[v]};
    return in_sphere_perturbed<3>(s, points_[w]) == Sign::positive;
  };
  std::make_heap(candidates_.begin(), candidates_.end(), later);
  while (!candidates_.empty()) {
    const Cell cell{f[0], f[1], f[2], candidates_.front()};
    if (!blocked(cell)) {
      cells_.push_back(cell);
      return replace_in_front(cell);
    }
    std::pop_heap(candidates_.begin(), candidates_.end(), later);
    candidates_.pop_back();
  }
  return false;
}

void GiftWrap::find_candidates(const Face& f) {
  candidates_.clear();
  const detail::SideOfPlane plane(points_[f[0]], points_[f[1]], points_[f[2]]);
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (std::find(f.begin(), f.end(), v) == f.end() && plane.of(points_[v]) == Sign::positive)
      candidates_.push_back(static_cast<Index>(v));
}

/// Does a triangle of the front meet the inside of the cell? Most are far away.
bool GiftWrap::blocked(const Cell& cell) {
  const detail::Box<3> box = box_of(cell);
  constexpr std::uint8_t unknown = 0xff;
  beyond_.assign(points_.size(), unknown);
  std::array<detail::SideOfPlane, 4> planes;
  for (int i = 0; i < 4; ++i) {
    const Face f = face_of(cell, i);
    planes[i] = {points_[f[0]], points_[f[1]], points_[f[2]]};
    beyond_[cell[i]] = static_cast<std::uint8_t>(15 & ~(1 << i));
  }
  const auto beyond = [&](Index v) {
    if (beyond_[v] != unknown) return beyond_[v];
    beyond_[v] = 0;
    for (int i = 0; i < 4; ++i)
      if (planes[i].of(points_[v]) != Sign::positive) beyond_[v] |= static_cast<std::uint8_t>(1 << i);
    return beyond_[v];
  };
  return std::any_of(front_.begin(), front_.end(), [&](const FrontFace& o) {
    for (int k = 0; k < 3; ++k)
      if (o.box.high[k] <= box.low[k] || box.high[k] <= o.box.low[k]) return false;
    const Face& f = o.vertices;
    const std::uint8_t a = beyond(f[0]), b = beyond(f[1]), c = beyond(f[2]);
    if ((a & b & c) != 0) return false;
    return a == 0 || b == 0 || c == 0 || meets(cell, f);  // 0: inside
  });
}

/// Two convex sets, one with an inside, keep out of each other's inside iff some plane keeps them apart; turned until it
/// can turn no further, such a plane goes through three corners that are on no line. The planes of the cell's faces
/// have been tried.
bool GiftWrap::meets(const Cell& cell, const Face& face) const {
  std::array<Index, 7> corner{};
  std::size_t n = 0;
  for (const Index v : cell) corner[n++] = v;
  for (const Index v : face)
    if (std::find(cell.begin(), cell.end(), v) == cell.end()) corner[n++] = v;
  auto keeps_apart = [&](Index a, Index b, Index c) {
    const detail::SideOfPlane plane(points_[a], points_[b], points_[c]);
    auto side = [&](Index v) { return v == a || v == b || v == c ? Sign::zero : plane.of(points_[v]); };
    Sign of_cell = Sign::zero;
    for (const Index v : cell) {
      const Sign s = side(v);
      if (s == Sign::zero) continue;
      if (of_cell == -s) return false;
      of_cell = s;
    }
    // Zero: the three are on one line.
    return of_cell != Sign::zero && std::all_of(face.begin(), face.end(), [&](Index v) { return side(v) != of_cell; });
  };
  for (std::size_t c = 4; c < n; ++c)  // at least one corner is the face's own
    for (std::size_t b = 1; b < c; ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (keeps_apart(corner[a], corner[b], corner[c])) return false;
  return true;
}

auto GiftWrap::find_in_front(const Face& f) -> std::vector<FrontFace>::iterator {
  return std::find_if(front_.begin(), front_.end(), [&f](const FrontFace& o) {
    return o.vertices[0] == f[0] && o.vertices[1] == f[1] && o.vertices[2] == f[2];  // as == calls memcmp
  });
}

/// The cell's faces leave the front or, turned over, enter it.
bool GiftWrap::replace_in_front(const Cell& cell) {
  for (int i = 0; i < 4; ++i) {
    const Face f = face_of(cell, i);
    if (const auto at = find_in_front(f); at != front_.end()) {
      *at = front_.back();
      front_.pop_back();
      continue;
    }
    const Face back = smallest_first(turned_over(f));
    if (find_in_front(back) != front_.end()) return false;
    add_to_front(back);
  }
  return true;
}

}  // namespace pgdr
