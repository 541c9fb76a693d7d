// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies/body_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "bodies/turns.hpp"
#include "input/diagonal.hpp"
#include "input/words.hpp"
#include "numbers/vectors.hpp"
#include "space/distances.hpp"
#include "space/equal_rows.hpp"

namespace pgdr::detail {
namespace {

/// The corners of a triangle in the order of their coordinates, so that what is computed of them does not depend on how they were
/// given; `is_odd`: that turns it over.
struct Ordered {
  std::array<Point<3>, 3> corners;
  bool is_odd = false;

  explicit Ordered(const std::array<Point<3>, 3>& s) : corners(s) {
    for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}})
      if (lex_less(corners[static_cast<std::size_t>(j)], corners[static_cast<std::size_t>(i)])) {
        std::swap(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(j)]);
        is_odd = !is_odd;
      }
  }
  friend bool operator<(const Ordered& a, const Ordered& b) {
    return std::lexicographical_compare(a.corners.begin(), a.corners.end(), b.corners.begin(), b.corners.end(), lex_less<3>);
  }
  Point<3> centre() const {
    Point<3> x;
    for (int i = 0; i < 3; ++i) x[i] = (corners[0][i] + corners[1][i] + corners[2][i]) / 3;
    return x;
  }
  Vector<3> normal() const { return cross(difference(corners[1], corners[0]), difference(corners[2], corners[0])); }
};

/// a + sign b, by body.
std::vector<Winding> sum(std::span<const Winding> a, std::span<const Winding> b, int sign) {
  std::vector<Winding> all;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const bool from_a = j == b.size() || (i < a.size() && a[i].body <= b[j].body);
    const bool from_b = i == a.size() || (j < b.size() && b[j].body <= a[i].body);
    const Winding w{from_a ? a[i].body : b[j].body, (from_a ? a[i].times : 0) + (from_b ? sign * b[j].times : 0)};
    if (w.times != 0) all.push_back(w);
    i += from_a;
    j += from_b;
  }
  return all;
}

}  // namespace

BodyVolumes::BodyVolumes(const Plc<3>& plc, const Arrangement& pieces, const Bulk& bulk, const StopCheck& stop_check)
    : plc_(plc), pieces_(pieces), walls_(pieces.points, pieces.triangles, bulk, stop_check) {
  require_known();
  chains_ = make_chains(plc, pieces, separating(), bulk);
  body_count_ = chains_.count;
  stop_check();
  measure_volumes();
  list_sides();
  wind_closed();
  require_consistent();
  if (plc.facet_bodies.empty()) join_cavities();
  stop_check();
  insides_.resize(count());
  bulk.parts(count() - 1, [this](std::size_t i) { insides_[i + 1] = find_inside(static_cast<std::uint32_t>(i + 1)); });
  stop_check();
  join_thin();
  wind_open(bulk);
  warn_of_turned();
}

std::vector<char> BodyVolumes::separating() const {
  std::vector<char> separates(pieces_.triangles.size());
  for (std::uint32_t p = 0; p < separates.size(); ++p) separates[p] = walls_.beside(p, false) != walls_.beside(p, true);
  return separates;
}

void BodyVolumes::require_known() const {
  for (std::uint32_t p = 0; p < pieces_.triangles.size(); ++p)
    for (const bool negative : {false, true})
      if (!walls_.is_known(walls_.beside(p, negative))) {
        const Point<3>& x = pieces_.points[pieces_.triangles[p][0]];
        throw InputError({Errc::ambiguous,
                          "no ray tells which volume the facets at " + to_text<3>(x) + " lie in: they are too thin",
                          plc_.source.file,
                          0,
                          {},
                          {x.x}});
      }
}

std::span<const PieceOfBody> BodyVolumes::at_piece(std::uint32_t piece) const {
  return equal_rows<PieceOfBody>(chains_.pieces, piece, &PieceOfBody::piece);
}

// A body's chain without open edges is a boundary: so its winding number changes at a piece by as often as it covers the piece,
// on whatever way one comes there.
void BodyVolumes::wind_closed() {
  windings_.resize(count());
  std::vector<char> done(count(), 0);
  std::vector<std::uint32_t> waiting{0};
  done[0] = 1;
  for (std::size_t next = 0; next < waiting.size(); ++next) {
    const std::uint32_t here = waiting[next];
    for (std::uint32_t k = sides_begin_[here]; k < sides_begin_[here + 1]; ++k) {
      const std::uint32_t piece = sides_[k] / 2;
      const bool from_negative = sides_[k] % 2 == 1;
      const std::uint32_t there = walls_.beside(piece, !from_negative);
      if (std::exchange(done[there], 1) != 0) continue;
      std::vector<Winding> step;
      for (const PieceOfBody& u : at_piece(piece))
        if (is_closed(u.body)) step.push_back({u.body, u.times});
      windings_[there] = sum(windings_[here], step, from_negative ? -1 : 1);
      waiting.push_back(there);
    }
  }
}

void BodyVolumes::require_consistent() const {
  for (std::uint32_t p = 0; p < pieces_.triangles.size(); ++p) {
    const std::uint32_t front = walls_.beside(p, false), behind = walls_.beside(p, true);
    if (front == behind) continue;
    std::vector<Winding> step;
    for (const PieceOfBody& u : at_piece(p))
      if (is_closed(u.body)) step.push_back({u.body, u.times});
    if (sum(windings_[behind], windings_[front], -1) != step)
      throw ResourceError({Errc::internal, "winding numbers do not agree", {}, 0, {}, {}});
  }
}

int BodyVolumes::total(std::uint32_t volume) const {
  int all = 0;
  for (const Winding& w : windings_[volume]) all += w.times;
  return all;
}

void BodyVolumes::list_sides() {
  const auto sides = static_cast<std::uint32_t>(2 * pieces_.triangles.size());
  sides_begin_.assign(count() + 1, 0);
  for (std::uint32_t s = 0; s < sides; ++s) ++sides_begin_[walls_.beside(s / 2, s % 2 == 1) + 1];
  for (std::uint32_t v = 0; v < count(); ++v) sides_begin_[v + 1] += sides_begin_[v];
  sides_.resize(sides);
  std::vector<std::uint32_t> next(sides_begin_.begin(), sides_begin_.end() - 1);
  for (std::uint32_t s = 0; s < sides; ++s) sides_[next[walls_.beside(s / 2, s % 2 == 1)]++] = s;
}

void BodyVolumes::measure_volumes() {
  measures_.resize(count());
  for (std::uint32_t p = 0; p < pieces_.triangles.size(); ++p) {
    const std::uint32_t front = walls_.beside(p, false), behind = walls_.beside(p, true);
    if (front == behind) continue;
    const auto s = walls_.hits().corners(p);
    measures_[behind].add_determinant(s[0], s[1], s[2]);
    measures_[front].add_determinant(s[1], s[0], s[2]);
  }
}

/// A closed body that is inside out belongs to the least body that it is in with all its pieces.
void BodyVolumes::join_cavities() {
  std::vector<ExactSum> measures(body_count_);
  std::vector<PieceOfBody> by_body = chains_.pieces;
  std::ranges::sort(by_body, {}, [](const PieceOfBody& u) { return std::pair(u.body, u.piece); });
  for (std::uint32_t v = 1; v < count(); ++v)
    for (const Winding& w : windings_[v])
      for (int n = std::abs(w.times); n > 0 && w.times > 0; --n) measures[w.body].add(measures_[v]);
  std::vector<char> is_inward(body_count_, 0);
  for (std::uint32_t v = 1; v < count(); ++v)
    for (const Winding& w : windings_[v]) is_inward[w.body] = is_inward[w.body] != 0 || w.times < 0;
  std::vector<std::uint32_t> host(body_count_);
  for (std::uint32_t b = 0; b < body_count_; ++b) {
    host[b] = b;
    if (is_inward[b] == 0 || !is_closed(b) || !measures[b].is_empty()) continue;
    host[b] = host_of(b, equal_rows<PieceOfBody>(by_body, b, &PieceOfBody::body), measures).value_or(b);
  }
  renumber(host);
}

std::optional<std::uint32_t> BodyVolumes::host_of(std::uint32_t body, std::span<const PieceOfBody> its_pieces,
                                                  std::span<const ExactSum> measures) const {
  std::vector<std::uint32_t> hosts;
  bool is_first = true;
  for (const PieceOfBody& u : its_pieces) {
    // Inside of the shell its winding number is negative: the piece's other side is in what has the cavity.
    std::vector<std::uint32_t> here;
    for (const Winding& w : windings_[walls_.beside(u.piece, u.times < 0)])
      if (w.times > 0 && w.body != body) here.push_back(w.body);
    if (std::exchange(is_first, false)) {
      hosts = std::move(here);
    } else {
      std::vector<std::uint32_t> both;
      std::ranges::set_intersection(hosts, here, std::back_inserter(both));
      hosts = std::move(both);
    }
  }
  std::optional<std::uint32_t> least;
  for (const std::uint32_t h : hosts)
    if (!least || measures[h].divided_by(6) < measures[*least].divided_by(6)) least = h;
  return least;
}

/// Bodies get numbers again, in the order of their first facets; `host`: which body each belongs to.
void BodyVolumes::renumber(std::span<const std::uint32_t> host) {
  std::vector<std::uint32_t> number(body_count_, no_entity);
  std::uint32_t numbered = 0;
  for (std::uint32_t& body : chains_.body_of_facet) {
    if (body == no_entity) continue;
    std::uint32_t& mine = number[host[body]];
    if (mine == no_entity) mine = numbered++;
    body = mine;
  }
  std::vector<char> closed(numbered, 1);
  for (std::uint32_t b = 0; b < body_count_; ++b)
    if (number[host[b]] != no_entity && !is_closed(b)) closed[number[host[b]]] = 0;
  for (PieceOfBody& u : chains_.pieces) u.body = number[host[u.body]];
  for (EdgeOfBody& e : chains_.open_edges) e.body = number[host[e.body]];
  for (std::vector<Winding>& list : windings_) {
    std::vector<Winding> all;
    for (const Winding& w : list) all = sum(all, std::array{Winding{number[host[w.body]], w.times}}, 1);
    list = std::move(all);
  }
  chains_.is_closed = std::move(closed);
  chains_.count = body_count_ = numbered;
}

void BodyVolumes::wind_open(const Bulk& bulk) {
  std::vector<PieceOfBody> open;
  for (const PieceOfBody& u : chains_.pieces)
    if (!is_closed(u.body)) open.push_back(u);
  if (open.empty()) return;
  std::ranges::sort(open, [this](const PieceOfBody& a, const PieceOfBody& b) {
    return a.body != b.body ? a.body < b.body : Ordered(walls_.hits().corners(a.piece)) < Ordered(walls_.hits().corners(b.piece));
  });
  std::vector<std::vector<Diagnostic>> unsure(count());
  bulk.parts(count() - 1, [&](std::size_t part) {
    const auto v = static_cast<std::uint32_t>(part + 1);
    if (!inside(v)) return;
    const Point<3>& x = *inside(v);
    std::vector<Winding> found;
    for (std::size_t i = 0, j = 0; i < open.size(); i = j) {
      Turns turns;
      for (j = i; j < open.size() && open[j].body == open[i].body; ++j) {
        Ordered t(walls_.hits().corners(open[j].piece));
        auto& s = t.corners;
        if ((open[j].times < 0) != t.is_odd) std::swap(s[0], s[1]);
        for (int n = std::abs(open[j].times); n > 0; --n) turns.add(x, s[0], s[1], s[2]);
      }
      const std::uint32_t body = open[i].body;
      if (turns.whole() != 0) found.push_back({body, turns.whole()});
      if (turns.is_sure()) continue;
      Diagnostic d{Errc::unsure_volume, {}, plc_.source.file, 0, {body}, {x.x}};
      d.message = "open body " + body_name(plc_, body) + " goes " + to_text(std::round(turns.number() * 1000) / 1000) +
                  " times round the volume about " + to_text<3>(x) + ", which is taken as " +
                  (turns.whole() == 0 ? "outside" : "inside");
      for (const EdgeOfBody& e : equal_rows<EdgeOfBody>(chains_.open_edges, body, &EdgeOfBody::body)) {
        if (d.points.size() > max_listed) break;
        d.points.push_back(pieces_.points[e.a].x);
      }
      unsure[v].push_back(std::move(d));
    }
    windings_[v] = sum(windings_[v], found, 1);
  });
  for (std::vector<Diagnostic>& list : unsure)
    for (Diagnostic& d : list) warnings_.push_back(std::move(d));
}

void BodyVolumes::warn_of_turned() {
  if (chains_.turned_over.empty()) return;
  RepairList turned;
  for (const std::uint32_t f : chains_.turned_over)
    turned.add([&] { return std::to_string(f + plc_.first_index); }, {f + plc_.first_index});
  turned.report(Errc::inconsistent_orientation, "facets that look the other way than their neighbours, turned over",
                plc_.source.file, warnings_);
}

/// Those that separate it from others; the largest first, and not too many.
std::vector<std::uint32_t> BodyVolumes::largest_sides(std::uint32_t volume) const {
  constexpr std::size_t most_sides = 256;
  struct Side {
    double area;
    std::uint32_t side;
  };
  std::vector<Side> sides;
  for (std::uint32_t k = sides_begin_[volume]; k < sides_begin_[volume + 1]; ++k) {
    const std::uint32_t s = sides_[k];
    if (walls_.beside(s / 2, s % 2 == 0) == volume) continue;
    const auto n = Ordered(walls_.hits().corners(s / 2)).normal();
    sides.push_back({dot(n, n), s});
  }
  const std::size_t count = std::min(sides.size(), most_sides);
  std::partial_sort(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(count), sides.end(),
                    [this](const Side& a, const Side& b) {
                      if (a.area != b.area) return a.area > b.area;
                      return Ordered(walls_.hits().corners(a.side / 2)) < Ordered(walls_.hits().corners(b.side / 2));
                    });
  std::vector<std::uint32_t> found(count);
  for (std::size_t i = 0; i < count; ++i) found[i] = sides[i].side;
  return found;
}

/// From the middle of the largest side inwards that has a point inside, by halves of the volume's extent; then away from the
/// nearest wall, as far as it gets deeper. So the seed that it becomes says as surely as may be which volume is meant.
std::optional<Point<3>> BodyVolumes::find_inside(std::uint32_t volume) const {
  constexpr int most_climbs = 8;
  const double extent = extent_of(volume);
  std::optional<Deep> deepest;
  for (const std::uint32_t side : largest_sides(volume)) {
    const Ordered t(walls_.hits().corners(side / 2));
    auto inwards = t.normal();
    if ((side % 2 == 1) != t.is_odd)
      for (double& x : inwards) x = -x;
    deepest = deepest_towards(volume, t.centre(), inwards, extent);
    if (deepest) break;
  }
  if (!deepest) return std::nullopt;
  for (int k = 0; k < most_climbs; ++k) {
    const auto deeper = deepest_towards(volume, deepest->x, difference(deepest->x, deepest->wall), extent);
    if (!deeper || !(deeper->square > deepest->square)) break;
    deepest = deeper;
  }
  return deepest->x;
}

/// The deepest point of the volume that is found from x in a direction, `reach` / 2 away, half of that, and so on, until it gets
/// less deep.
auto BodyVolumes::deepest_towards(std::uint32_t volume, const Point<3>& from, const Vector<3>& way, double reach) const
    -> std::optional<Deep> {
  const double size = std::sqrt(dot(way, way));
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  std::optional<Deep> deepest;
  Point<3> last = from;
  for (int k = 1; k < 64; ++k) {
    Point<3> x;
    for (int i = 0; i < 3; ++i) x[i] = from[i] + way[static_cast<std::size_t>(i)] / size * std::ldexp(reach, -k);
    if (x == last) break;  // the steps are smaller than the digits
    last = x;
    if (walls_.find(x) != volume) continue;
    const Deep here = depth_at(x);
    if (deepest && !(here.square > deepest->square)) break;
    deepest = here;
  }
  return deepest;
}

double BodyVolumes::extent_of(std::uint32_t volume) const {
  Box<3> box = Box<3>::empty();
  for (std::uint32_t k = sides_begin_[volume]; k < sides_begin_[volume + 1]; ++k)
    for (const Point<3>& p : walls_.hits().corners(sides_[k] / 2)) box.add(p);
  return diagonal_of(box);
}

auto BodyVolumes::depth_at(const Point<3>& x) const -> Deep {
  Deep deep{x, x, std::numeric_limits<double>::infinity()};
  walls_.hits().tree().nearest([&](const Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); },
                               [&](std::uint32_t w) {
                                 const auto [a, b, c] = walls_.hits().corners(w);
                                 const auto closest = closest_to_triangle(x, a, b, c);
                                 if (closest.square < deep.square) deep = {x, closest.points[1], closest.square};
                                 return deep.square;
                               });
  return deep;
}

/// To the volume behind the largest side that one is known of.
void BodyVolumes::join_thin() {
  std::vector<std::uint32_t> left;
  for (std::uint32_t v = 1; v < count(); ++v)
    if (!insides_[v]) left.push_back(v);
  if (left.empty()) return;
  std::vector<char> known(count(), 1);
  for (const std::uint32_t v : left) known[v] = 0;
  Diagnostic d{Errc::ambiguous, {}, plc_.source.file, 0, {}, {}};
  for (std::size_t before = left.size() + 1; !left.empty() && left.size() < before;) {
    before = left.size();
    std::vector<std::uint32_t> later;
    for (const std::uint32_t v : left) {
      const auto sides = largest_sides(v);
      const auto beside = [this](std::uint32_t s) { return walls_.beside(s / 2, s % 2 == 0); };
      const auto side = std::ranges::find_if(sides, [&](std::uint32_t s) { return known[beside(s)] != 0; });
      if (side == sides.end()) {
        later.push_back(v);
        continue;
      }
      thin_.push_back({v, *side / 2, beside(*side)});
      d.points.push_back(pieces_.points[pieces_.triangles[*side / 2][0]].x);
    }
    for (const ThinVolume& t : thin_) known[t.volume] = 1;
    left = std::move(later);
  }
  d.message = std::to_string(thin_.size()) + " volumes are so thin that no point is inside, and count to those beside them";
  warnings_.push_back(std::move(d));
}

}  // namespace pgdr::detail
