// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/planar_plc.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "input/edges.hpp"
#include "input/words.hpp"
#include "numbers/double_double.hpp"
#include "numbers/finite.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/contact.hpp"
#include "space/make_set.hpp"

namespace pgdr {
namespace {

using detail::Contact;
using detail::DoubleDouble;

constexpr int most_rounds = 1000;
/// Edges go through the points that they pass so nearly, within this times the largest coordinate's power of two. A file that
/// rounds its coordinates keeps no point on a slanted segment; new points miss others by an ulp where three segments meet; and
/// bundles of segments nearly of one line, each moved by an ulp where it is split, would cross ever anew, at ever more places.
constexpr double near = rounding::of_point;

struct LexLess {
  bool operator()(const Point2& a, const Point2& b) const { return lex_less(a, b); }
};

bool is_usable(const Plc<2>& plc) {
  if (!std::ranges::all_of(plc.points, detail::is_finite<2>)) return false;
  for (const auto& s : plc.segments)
    for (const std::uint32_t v : s.points)
      if (v >= plc.points.size()) return false;
  return true;
}

/// First of the points at each place.
std::vector<std::uint32_t> first_at_place(const std::vector<Point2>& points) {
  std::map<Point2, std::uint32_t, LexLess> seen;
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) first[i] = seen.try_emplace(points[i], i).first->second;
  return first;
}

/// Where the lines ab and cd meet, rounded once. @pre the insides of the segments cross
Point2 intersection(Point2 a, Point2 b, Point2 c, Point2 d) {
  double largest = 0;
  for (const Point2* p : {&a, &b, &c, &d})
    for (const double x : p->x) largest = std::max(largest, std::fabs(x));
  const int e = std::ilogb(largest);
  for (Point2* p : {&a, &b, &c, &d})
    for (double& x : p->x) x = std::ldexp(x, -e);
  const std::array u{detail::difference(b[0], a[0]), detail::difference(b[1], a[1])};
  const std::array w{detail::difference(d[0], c[0]), detail::difference(d[1], c[1])};
  const std::array from{detail::difference(c[0], a[0]), detail::difference(c[1], a[1])};
  const DoubleDouble t = (from[0] * w[1] - from[1] * w[0]) / (u[0] * w[1] - u[1] * w[0]);
  Point2 x;
  for (int i = 0; i < 2; ++i) x[i] = std::ldexp((DoubleDouble(a[i]) + u[static_cast<std::size_t>(i)] * t).rounded(), e) + 0.0;
  return x;
}

/// Makes the segments of a PLC cross no more, round by round.
class CrossingResolver {
 public:
  explicit CrossingResolver(const Plc<2>& plc) : points_(plc.points) {
    const auto first = first_at_place(points_);
    for (std::uint32_t i = 0; i < points_.size(); ++i) at_.try_emplace(points_[i], first[i]);
    for (std::uint32_t s = 0; s < plc.segments.size(); ++s) {
      const auto [a, b] = plc.segments[s].points;
      edges_.push_back({{first[a], first[b]}, s});
    }
  }

  /// True if anything was split. Edges are split first where points lie on them or nearly so: as pieces of what was split at a
  /// rounded point they would miss these by an ulp, and segments that overlap would enclose slivers.
  bool split_once() {
    std::vector<std::uint64_t> keys;
    for (const detail::OwnedEdge& e : edges_)
      if (e.edge[0] != e.edge[1]) keys.push_back(detail::edge_key(e.edge[0], e.edge[1]));
    detail::make_set(keys);
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const std::uint64_t key : keys) corners.push_back({detail::edge_of(key)[0], detail::edge_of(key)[1], no_entity});
    for (const std::uint32_t v : loose_points()) corners.push_back({v, no_entity, no_entity});
    std::vector<std::array<std::uint32_t, 2>> crossing;
    inside_.clear();
    const detail::BoxTree<2> tree(corners, points_);
    const auto piece = [&](std::uint32_t i) {
      return detail::Piece{corners[i], static_cast<std::uint8_t>(i < keys.size() ? 2 : 1), 0};
    };
    tree.self_pairs([&](std::uint32_t i, std::uint32_t j) {
      if (i >= keys.size() && j >= keys.size()) return;
      const Contact contact = detail::contact<2>(points_, piece(i), piece(j));
      if (contact.kind == Contact::Kind::cross) crossing.push_back({i, j});
      for (const Contact::Corner& c : contact.corners)
        if (c.edge[0] != no_entity) inside_.emplace_back(detail::edge_key(c.edge[0], c.edge[1]), c.point);
    });
    detail::make_set(inside_);
    const std::size_t exactly = inside_.size();
    collect_near(keys);
    detail::make_set(inside_);
    if (crossing.empty() && inside_.size() == exactly) return false;
    if (inside_.empty()) {
      std::sort(crossing.begin(), crossing.end());
      for (const auto& [i, j] : crossing) split_at(keys[i], keys[j]);
      detail::make_set(inside_);
    } else {
      touching_.insert(touching_.end(), inside_.begin(), inside_.end());
    }
    replace_edges();
    return true;
  }

  /// Points, and edges, or pieces of such, that had them inside before they were crossed.
  const std::vector<detail::PointOn>& touching() const { return touching_; }
  const std::vector<Point2>& points() const { return points_; }
  const std::vector<detail::OwnedEdge>& edges() const { return edges_; }
  /// Of the new points, in their order: the ends of the edge that each was made on. These may be new points before it.
  const std::vector<std::array<std::uint32_t, 2>>& origins() const { return origins_; }
  /// Pairs of segments that crossed, by their indices.
  const std::set<std::pair<std::uint32_t, std::uint32_t>>& pairs() const { return pairs_; }

 private:
  /// The first point at each place, but for the ends of edges.
  std::vector<std::uint32_t> loose_points() const {
    std::vector<bool> used(points_.size());
    for (const detail::OwnedEdge& e : edges_)
      for (const std::uint32_t v : e.edge) used[v] = true;
    std::vector<std::uint32_t> loose;
    for (const auto& [point, v] : at_)
      if (!used[v]) loose.push_back(v);
    return loose;
  }

  /// Points that edges pass nearly, much farther along them than off them: so the pieces are shorter than the edge, and
  /// this comes to an end.
  void collect_near(const std::vector<std::uint64_t>& keys) {
    double largest = 0;
    for (const Point2& p : points_)
      for (const double x : p.x) largest = std::max(largest, std::fabs(x));
    const int e = std::ilogb(largest);
    std::vector<Point2> scaled(points_);
    for (Point2& p : scaled)
      for (double& x : p.x) x = std::ldexp(x, -e);
    std::vector<detail::Box<2>> boxes;
    for (const std::uint64_t key : keys) {
      const auto [a, b] = detail::edge_of(key);
      auto box = detail::Box<2>::around(scaled[a]);
      box.add(scaled[b]);
      boxes.push_back(box.widened(near));
    }
    std::vector<std::uint32_t> vertices;
    for (const auto& [point, v] : at_) {
      vertices.push_back(v);
      boxes.push_back(detail::Box<2>::around(scaled[v]));
    }
    detail::BoxTree<2>(boxes).self_pairs([&](std::uint32_t i, std::uint32_t j) {
      if (i >= keys.size() || j < keys.size()) return;
      const auto [a, b] = detail::edge_of(keys[i]);
      const std::uint32_t v = vertices[j - keys.size()];
      if (v == a || v == b) return;
      const Point2 &p = scaled[a], &q = scaled[b], &x = scaled[v];
      const double length2 = squared_distance(p, q);
      const double along = (x[0] - p[0]) * (q[0] - p[0]) + (x[1] - p[1]) * (q[1] - p[1]);
      const double off = (x[0] - p[0]) * (q[1] - p[1]) - (x[1] - p[1]) * (q[0] - p[0]), off2 = off * off / length2;
      if (along > 0 && along < length2 && off2 <= near * near &&
          4 * off2 <= std::min(squared_distance(p, x), squared_distance(q, x)))
        inside_.emplace_back(keys[i], v);
    });
  }

  void split_at(std::uint64_t first, std::uint64_t second) {
    const auto [a, b] = detail::edge_of(first);
    const auto [c, d] = detail::edge_of(second);
    const Point2 x = intersection(points_[a], points_[b], points_[c], points_[d]);
    const auto [at, is_new] = at_.try_emplace(x, static_cast<std::uint32_t>(points_.size()));
    if (is_new) {
      points_.push_back(x);
      origins_.push_back({a, b});
    }
    const std::uint32_t v = at->second;
    if (v != a && v != b) inside_.emplace_back(first, v);
    if (v != c && v != d) inside_.emplace_back(second, v);
    crossed_.emplace_back(first, second);
  }

  void replace_edges() {
    note_pairs();
    std::vector<detail::OwnedEdge> pieces;
    for (const detail::OwnedEdge& e : edges_) {
      const auto chain = chain_of(e.edge[0], e.edge[1]);
      for (std::size_t k = 1; k < chain.size(); ++k) pieces.push_back({{chain[k - 1], chain[k]}, e.owner});
    }
    edges_ = std::move(pieces);
  }

  /// Which segments the edges of this round are pieces of.
  void note_pairs() {
    std::multimap<std::uint64_t, std::uint32_t> owners;
    for (const detail::OwnedEdge& e : edges_) owners.emplace(detail::edge_key(e.edge[0], e.edge[1]), e.owner);
    for (const auto& [first, second] : crossed_)
      for (auto [i, last] = owners.equal_range(first); i != last; ++i)
        for (auto [j, end] = owners.equal_range(second); j != end; ++j)
          pairs_.emplace(std::min(i->second, j->second), std::max(i->second, j->second));
    crossed_.clear();
  }

  /// a, the points inside the edge in their order along it, b.
  std::vector<std::uint32_t> chain_of(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> chain{a};
    const std::uint64_t key = detail::edge_key(a, b);
    for (auto i = std::lower_bound(inside_.begin(), inside_.end(), detail::PointOn{key, 0});
         i != inside_.end() && i->first == key; ++i)
      chain.push_back(i->second);
    const Point2 &p = points_[a], &q = points_[b];
    const int axis = std::fabs(q[0] - p[0]) >= std::fabs(q[1] - p[1]) ? 0 : 1;
    const auto along = [&](std::uint32_t v) {
      const auto sign = [&](int i) { return q[i] < p[i] ? -points_[v][i] : points_[v][i]; };
      return std::pair(sign(axis), sign(1 - axis));
    };
    std::sort(chain.begin() + 1, chain.end(), [&](std::uint32_t v, std::uint32_t w) { return along(v) < along(w); });
    chain.push_back(b);
    return chain;
  }

  std::vector<Point2> points_;
  std::map<Point2, std::uint32_t, LexLess> at_;  ///< the first point at each place
  std::vector<detail::OwnedEdge> edges_;
  std::vector<std::array<std::uint32_t, 2>> origins_;
  std::vector<detail::PointOn> touching_;
  std::vector<detail::PointOn> inside_;  ///< of this round, sorted
  std::vector<std::pair<std::uint64_t, std::uint64_t>> crossed_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

void report(const CrossingResolver& resolved, const Plc<2>& plc, std::vector<Diagnostic>& repairs) {
  detail::RepairList list;
  const auto number = [&](std::uint32_t s) { return std::int64_t{s} + plc.first_index; };
  for (const auto& [s, t] : resolved.pairs()) {
    const std::int64_t first = number(s), second = number(t);
    list.add([&] { return std::to_string(first) + " x " + std::to_string(second); }, {first, second});
  }
  for (std::size_t i = plc.points.size(); i < resolved.points().size(); ++i)
    list.diagnostic.points.push_back(detail::in_space(resolved.points()[i]));
  detail::RepairList touching;
  for (const auto& [edge, v] : resolved.touching()) {
    const std::int64_t point = number(v), from = number(detail::edge_of(edge)[0]), to = number(detail::edge_of(edge)[1]);
    const auto words = [&] { return std::to_string(point) + " in " + std::to_string(from) + "-" + std::to_string(to); };
    touching.add(words, {point, from, to});
  }
  detail::RepairList dropped;
  for (std::uint32_t s = 0; s < plc.segments.size(); ++s) {
    const auto [a, b] = plc.segments[s].points;
    const std::int64_t segment = number(s);
    if (plc.points[a] == plc.points[b]) dropped.add([&] { return std::to_string(segment); }, {segment, number(a), number(b)});
  }
  dropped.report(Errc::degenerate_segment, "segments of no length, dropped", plc.source.file, repairs);
  touching.report(Errc::point_on_segment, "points inside a segment, which is split there", plc.source.file, repairs);
  list.report(Errc::entities_intersect, "segments that cross, now split there", plc.source.file, repairs);
}

/// Those of the new points: linear along the edge that they were made on.
void append_attributes(const CrossingResolver& resolved, Plc<2>& plc, std::size_t old_points) {
  const std::size_t columns = old_points == 0 ? 0 : plc.point_attributes.size() / old_points;
  if (columns * old_points != plc.point_attributes.size()) return;  // Domain refuses it
  const auto& p = resolved.points();
  for (std::size_t i = 0; i < resolved.origins().size(); ++i) {
    const auto [a, b] = resolved.origins()[i];
    const int axis = std::fabs(p[b][0] - p[a][0]) >= std::fabs(p[b][1] - p[a][1]) ? 0 : 1;
    const double t = std::clamp((p[old_points + i][axis] - p[a][axis]) / (p[b][axis] - p[a][axis]), 0.0, 1.0);
    for (std::size_t k = 0; k < columns; ++k) {
      const double from = plc.point_attributes[a * columns + k], to = plc.point_attributes[b * columns + k];
      plc.point_attributes.push_back((1 - t) * from + t * to);
    }
  }
}

}  // namespace

Plc<2> resolve_crossings(const Plc<2>& plc, std::vector<Diagnostic>& repairs) {
  if (!is_usable(plc)) return plc;
  CrossingResolver resolver(plc);
  int rounds = 0;
  while (resolver.split_once())
    if (++rounds == most_rounds)
      throw InputError(
          {Errc::entities_intersect, "crossings of segments lead to ever new crossings", plc.source.file, 0, {}, {}});
  if (rounds == 0) return plc;
  report(resolver, plc, repairs);
  Plc<2> out = plc;
  out.points = resolver.points();
  if (!out.point_markers.empty()) out.point_markers.resize(out.points.size(), 0);
  append_attributes(resolver, out, plc.points.size());
  out.segments.clear();
  out.source.segment_lines.clear();
  for (const detail::OwnedEdge& e : resolver.edges()) {
    if (e.edge[0] == e.edge[1]) continue;  // it has no length, and is dropped
    out.segments.push_back({e.edge, plc.segments[e.owner].marker});
    if (e.owner < plc.source.segment_lines.size()) out.source.segment_lines.push_back(plc.source.segment_lines[e.owner]);
  }
  return out;
}

Plc<2> with_convex_hull(const Plc<2>& plc) {
  if (!is_usable(plc)) return plc;
  const auto& p = plc.points;
  const auto first = first_at_place(p);
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < p.size(); ++i)
    if (first[i] == i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return lex_less(p[a], p[b]); });
  std::set<std::uint64_t> known;
  for (const auto& s : plc.segments) known.insert(detail::edge_key(first[s.points[0]], first[s.points[1]]));
  Plc<2> out = plc;
  for (int half = 0; half < 2; ++half) {
    // From one end of the order to the other, points on its edges included (Andrew 1979).
    std::vector<std::uint32_t> chain;
    for (const std::uint32_t v : order) {
      while (chain.size() >= 2 && orient2d(p[chain.end()[-2]], p[chain.back()], p[v]) == Sign::negative) chain.pop_back();
      chain.push_back(v);
    }
    for (std::size_t k = 1; k < chain.size(); ++k)
      if (known.insert(detail::edge_key(chain[k - 1], chain[k])).second) out.segments.push_back({{chain[k - 1], chain[k]}, 0});
    std::reverse(order.begin(), order.end());
  }
  if (!out.source.segment_lines.empty()) out.source.segment_lines.resize(out.segments.size(), 0);
  return out;
}

}  // namespace pgdr
