// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Construction and point location of the planar triangulation. Points go in by a biased randomised order (rounds of
// doubling size, Hilbert order within each; Amenta, Choi, Rote 2003), which keeps walks and flips short. While
// constraints go in, circles are those of the projection, which are consistent whatever the dropped coordinates; a last
// sweep of flips passes on to the circles of the plane in space.
#include "space/planar_cdt.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

std::uint32_t hash_of(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

// Position of (x, y), both below 2^16, on the Hilbert curve of that square.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t d = 0;
  for (std::uint32_t s = 1u << 15; s != 0; s >>= 1) {
    const std::uint32_t rx = (x & s) != 0, ry = (y & s) != 0;
    d = (d << 2) | ((3 * rx) ^ ry);
    if (ry != 0) continue;
    if (rx != 0) {
      x = ~x & 0xffffu;
      y = ~y & 0xffffu;
    }
    std::swap(x, y);
  }
  return d;
}

std::vector<std::uint32_t> insertion_order(std::span<const Point3> points, int axis) {
  const int u = (axis + 1) % 3, w = (axis + 2) % 3;
  double low[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double extent = 0;  // all halved: the largest doubles are allowed
  for (const Point3& p : points) {
    low[0] = std::min(low[0], p[u] / 2);
    low[1] = std::min(low[1], p[w] / 2);
  }
  for (const Point3& p : points) extent = std::max({extent, p[u] / 2 - low[0], p[w] / 2 - low[1]});
  // 65535 / extent may overflow for subnormal extents; the order then is any.
  const double scale = extent > 0 && std::isfinite(65535 / extent) ? 65535 / extent : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.size());
  const auto grid = [scale](double d) { return static_cast<std::uint32_t>(std::clamp(d * scale, 0.0, 65535.0)); };
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint64_t round = static_cast<std::uint64_t>(std::countr_zero(hash_of(i) | 0x10000u));
    const std::uint32_t place = hilbert_index(grid(points[i][u] / 2 - low[0]), grid(points[i][w] / 2 - low[1]));
    keys[i] = {((16 - round) << 32) | place, i};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(points.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& k) { return k.second; });
  return order;
}

}  // namespace

std::uint32_t PlanarTriangulation::local(std::uint32_t id) const {
  const auto it = std::lower_bound(local_of_.begin(), local_of_.end(), std::pair{id, 0u});
  return it != local_of_.end() && it->first == id ? it->second : none;
}

std::uint32_t PlanarTriangulation::add_vertex(std::uint32_t id, const Point3& p) {
  const auto v = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  ids_.push_back(id);
  cell_of_.push_back(none);
  const std::pair entry{id, v};  // new ids mostly are the largest
  const auto at = std::upper_bound(local_of_.begin(), local_of_.end(), entry);
  local_of_.insert(at, entry);
  return v;
}

PlanarResult PlanarTriangulation::build(std::span<const Point3> points, std::span<const std::uint32_t> vertices,
                                        std::span<const PlanarEdge> constraints, int axis) {
  axis_ = axis;
  PlanarResult result = build_delaunay(points, vertices);
  for (std::size_t k = 0; result && k < constraints.size(); ++k) {
    const std::uint32_t a = local(constraints[k][0]), b = local(constraints[k][1]);
    if (a == none || b == none)
      result = {PlanarStatus::no_such_edge, constraints[k], {}};
    else if (a != b)
      result = constrain_local(a, b, false);
  }
  if (!result) {
    *this = {};
    return result;
  }
  std::vector<Side> stack;
  for (std::uint32_t t = static_cast<std::uint32_t>(cells_.size()); t-- > 0;)
    for (int i = 0; i < 3; ++i)
      if (cells_[t].n[static_cast<std::size_t>(i)] < t) stack.push_back({t, i});
  legalize(stack, false, false);
  return result;
}

PlanarResult PlanarTriangulation::build_delaunay(std::span<const Point3> points, std::span<const std::uint32_t> vertices) {
  points_.clear();
  ids_.assign(vertices.begin(), vertices.end());
  cells_.clear();
  local_of_.clear();
  touch_stamp_.clear();
  outside_is_crooked_ = false;
  for (const std::uint32_t v : vertices) {
    local_of_.emplace_back(v, static_cast<std::uint32_t>(points_.size()));
    points_.push_back(points[v]);
  }
  std::sort(local_of_.begin(), local_of_.end());
  cell_of_.assign(points_.size(), none);
  if (points_.size() < 3) return {PlanarStatus::collinear};
  std::vector<std::uint32_t> order = insertion_order(points_, axis_);
  PlanarResult result = start(order);
  for (std::size_t k = 3; result && k < order.size(); ++k) result = insert_in_hull(order[k]);
  return result;
}

// The first triangle and its three ghosts; moves its corners to the front of the order.
PlanarResult PlanarTriangulation::start(std::vector<std::uint32_t>& order) {
  const int u = (axis_ + 1) % 3, w = (axis_ + 2) % 3;
  const auto same = [&](const Point3& p, const Point3& q) { return p[u] == q[u] && p[w] == q[w]; };
  const std::uint32_t a = order[0], b = order[1];
  if (same(points_[a], points_[b])) return problem(PlanarStatus::coincident, a, b);
  std::size_t third = 2;
  while (third < order.size() && orient(a, b, order[third]) == Sign::zero) ++third;
  if (third == order.size()) return {PlanarStatus::collinear};
  std::rotate(order.begin() + 2, order.begin() + static_cast<std::ptrdiff_t>(third),
              order.begin() + static_cast<std::ptrdiff_t>(third) + 1);
  const std::uint32_t c = order[2];
  const bool turned = orient(a, b, c) == Sign::negative;
  const std::array<std::uint32_t, 3> v{a, turned ? c : b, turned ? b : c};
  cells_.resize(4);
  set_cell(0, v, 0, true);
  for (std::uint32_t i = 0; i < 3; ++i) set_cell(1 + i, {ghost, v[(i + 2) % 3], v[(i + 1) % 3]}, 0, false);
  for (std::uint32_t i = 0; i < 3; ++i) {
    link({0, static_cast<int>(i)}, {1 + i, 0});
    link({1 + i, 1}, {1 + (i + 2) % 3, 2});  // around v[i+1]: the ghosts of edges i and i+2
  }
  hint_ = 0;
  return {};
}

PlanarResult PlanarTriangulation::insert_in_hull(std::uint32_t v) {
  const Location where = locate(points_[v]);
  if (where.vertex >= 0) return problem(PlanarStatus::coincident, cells_[where.t].v[static_cast<std::size_t>(where.vertex)], v);
  std::vector<std::uint32_t> cells{where.t};
  if (where.edge >= 0) cells.push_back(cells_[where.t].n[static_cast<std::size_t>(where.edge)]);
  fill_star(v, rim_of(where), cells, {none, none}, true);
  return {};
}

PlanarTriangulation::Location PlanarTriangulation::locate_in(std::uint32_t t, const std::array<Sign, 3>& side) const {
  const int zeros = static_cast<int>(std::count(side.begin(), side.end(), Sign::zero));
  Location where{t, -1, -1};
  for (int i = 0; i < 3; ++i) {
    if (zeros == 1 && side[static_cast<std::size_t>(i)] == Sign::zero) where.edge = i;
    if (zeros == 2 && side[static_cast<std::size_t>(i)] != Sign::zero) where.vertex = i;
  }
  return where;
}

PlanarTriangulation::Location PlanarTriangulation::locate(const Point3& p) const {
  const Location where = walk_to(p);
  return where.t == none || is_out(cells_[where.t]) ? locate_by_scan(p) : where;
}

// Walks towards p, leaving each cell through the first edge, from one of changing number, that has p behind it: that
// ends in a Delaunay triangulation always, with constraints almost always; the scan is for the rest.
PlanarTriangulation::Location PlanarTriangulation::walk_to(const Point3& p) const {
  std::uint32_t t = hint_ < cells_.size() ? hint_ : 0, random = 1;
  if (is_ghost(cells_[t])) {
    for (std::size_t i = 0; i < 3; ++i)
      if (cells_[t].v[i] == ghost) {
        t = cells_[t].n[i];
        break;
      }
  }
  for (std::size_t steps = 0; steps < 4 * cells_.size() + 100; ++steps) {
    const Cell& c = cells_[t];
    if (is_ghost(c)) return {t, -1, -1};  // strictly beyond a hull edge
    random = random * 1664525u + 1013904223u;
    std::array<Sign, 3> side{};
    int out = -1;
    for (int k = 0; k < 3 && out < 0; ++k) {
      const std::size_t i = ((random >> 16) + static_cast<std::uint32_t>(k)) % 3;
      side[i] = orient_projected(points_[c.v[(i + 1) % 3]], points_[c.v[(i + 2) % 3]], p, axis_);
      if (side[i] == Sign::negative) out = static_cast<int>(i);
    }
    if (out < 0) return locate_in(t, side);
    t = c.n[static_cast<std::size_t>(out)];
  }
  return {};
}

PlanarTriangulation::Location PlanarTriangulation::locate_by_scan(const Point3& p) const {
  Location beyond{0, -1, -1};
  for (std::uint32_t t = 0; t < cells_.size(); ++t) {
    const Cell& c = cells_[t];
    if (is_out(c)) {
      beyond = {t, -1, -1};
      continue;
    }
    std::array<Sign, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = c.v[(i + 1) % 3], b = c.v[(i + 2) % 3];
      if (a != ghost && b != ghost) side[i] = orient_projected(points_[a], points_[b], p, axis_);
    }
    if (is_ghost(c)) {
      if (std::count(side.begin(), side.end(), Sign::positive) == 1) beyond = {t, -1, -1};
    } else if (std::count(side.begin(), side.end(), Sign::negative) == 0) {
      return locate_in(t, side);
    }
  }
  return beyond;
}

void PlanarTriangulation::flood(std::vector<std::uint32_t>& queue, bool inside) {
  while (!queue.empty()) {
    const std::uint32_t t = queue.back();
    queue.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      Cell& next = cells_[cells_[t].n[i]];
      if (is_fixed(cells_[t], i) || next.inside == inside || is_ghost(next)) continue;
      next.inside = inside;
      queue.push_back(cells_[t].n[i]);
    }
  }
}

void PlanarTriangulation::carve_outside() {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t t = 0; t < cells_.size(); ++t)
    if (is_ghost(cells_[t])) queue.push_back(t);
  flood(queue, false);
}

PlanarResult PlanarTriangulation::carve_hole(const Point3& p) {
  if (cells_.empty()) return {PlanarStatus::outside};
  const Location where = locate(p);
  const Cell& c = cells_[where.t];
  if (where.vertex >= 0) {
    const std::uint32_t v = c.v[static_cast<std::size_t>(where.vertex)];
    return problem(PlanarStatus::on_constraint, v, v);
  }
  if (where.edge >= 0 && is_fixed(c, where.edge))
    return problem(PlanarStatus::on_constraint, c.v[static_cast<std::size_t>((where.edge + 1) % 3)],
                   c.v[static_cast<std::size_t>((where.edge + 2) % 3)]);
  if (is_ghost(c) || !c.inside) return {PlanarStatus::outside};
  std::vector<std::uint32_t> queue{where.t};
  cells_[where.t].inside = false;
  flood(queue, false);
  return {};
}

void PlanarTriangulation::keep_left_of(std::span<const PlanarEdge> edges) {
  for (Cell& c : cells_) c.inside = false;
  std::vector<std::uint32_t> queue;
  for (const auto& [a, b] : edges) {
    const std::uint32_t u = local(a), w = local(b);
    if (u == none || w == none) continue;
    const Side s = find_edge(u, w);
    if (s.t == none || !is_fixed(cells_[s.t], s.i) || cells_[s.t].inside || is_ghost(cells_[s.t])) continue;
    cells_[s.t].inside = true;
    queue.push_back(s.t);
    flood(queue, true);
  }
}

std::vector<PlanarTriangle> PlanarTriangulation::triangles() const {
  std::vector<PlanarTriangle> out;
  for (const Cell& c : cells_)
    if (c.inside) out.push_back({ids_[c.v[0]], ids_[c.v[1]], ids_[c.v[2]]});
  return out;
}

std::vector<std::uint8_t> PlanarTriangulation::constraint_masks() const {
  std::vector<std::uint8_t> out;
  for (const Cell& c : cells_)
    if (c.inside) out.push_back(c.fixed);
  return out;
}

}  // namespace pgdr::detail
