// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/polyhedron_filling.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "numbers/side_of_plane.hpp"
#include "numbers/vectors.hpp"

namespace pgdr {
namespace {

using Index = Polyhedron::Index;
using Triple = std::array<Index, 3>;  // ascending
using Quad = Polyhedron::Cell;        // ascending

constexpr std::size_t most = PolyhedronFilling::most_points;
constexpr std::uint32_t unknown_set = 0xffffffffu;
constexpr std::uint8_t unknown = 2;

/// Binomial coefficients: how many sets of K numbers below n there are.
template <int K>
constexpr std::size_t sets_below(std::size_t n) {
  if constexpr (K == 2) return n * (n - 1) / 2;
  if constexpr (K == 3) return n * (n - 1) * (n - 2) / 6;
  return n * (n - 1) * (n - 2) * (n - 3) / 24;
}
/// The same by table; n - 1 of no numbers may not wrap.
template <int K>
constexpr auto set_table = [] {
  std::array<std::uint16_t, most + 1> table{};
  for (std::size_t n = K; n <= most; ++n) table[n] = static_cast<std::uint16_t>(sets_below<K>(n));
  return table;
}();

/// Sets of ascending numbers are numbered such that those of numbers below n come before all others.
std::size_t number_of(const std::array<Index, 2>& s) { return set_table<2>[s[1]] + s[0]; }
std::size_t number_of(const Triple& s) { return set_table<3>[s[2]] + set_table<2>[s[1]] + s[0]; }
std::size_t number_of(const Quad& s) { return set_table<4>[s[3]] + set_table<3>[s[2]] + set_table<2>[s[1]] + s[0]; }

constexpr auto all_triples = [] {
  std::array<Triple, sets_below<3>(most)> all{};
  std::size_t n = 0;
  for (Index c = 2; c < most; ++c)
    for (Index b = 1; b < c; ++b)
      for (Index a = 0; a < b; ++a) all[n++] = {a, b, c};
  return all;
}();

constexpr std::uint32_t bit(Index i) { return std::uint32_t{1} << i; }
template <std::size_t N>
constexpr std::uint32_t bits(const std::array<Index, N>& s) {
  std::uint32_t all = 0;
  for (const Index i : s) all |= bit(i);
  return all;
}

Triple ascending(Index a, Index b, Index c) {
  if (b < a) std::swap(a, b);
  if (c < b) std::swap(b, c);
  if (b < a) std::swap(a, b);
  return {a, b, c};
}
/// A cell: its corners, whether they are in negative order, and the place of its apex among them.
struct Placed {
  Quad corners;
  bool turned;
  int place;
};
Placed with_apex(std::size_t face, Index apex) {
  const Triple& t = all_triples[face / 2];
  const bool below = face % 2;
  if (apex < t[0]) return {{apex, t[0], t[1], t[2]}, !below, 0};
  if (apex < t[1]) return {{t[0], apex, t[1], t[2]}, below, 1};
  if (apex < t[2]) return {{t[0], t[1], apex, t[2]}, !below, 2};
  return {{t[0], t[1], t[2], apex}, below, 3};
}
Triple face_opposite(const Quad& q, int i) { return {q[i > 0 ? 0 : 1], q[i > 1 ? 1 : 2], q[i > 2 ? 2 : 3]}; }
/// The number of the face opposite corner i, seen from within.
std::uint16_t face_of(const Quad& q, bool turned, int i) {
  return static_cast<std::uint16_t>(2 * number_of(face_opposite(q, i)) + (turned != (i % 2 == 0)));
}

}  // namespace

void Polyhedron::clear() {
  points.clear();
  faces.clear();
  edges.clear();
  kept.clear();
  flat_sets.clear();
  region = 0;
  volume6 = 0;
}

PolyhedronFilling::PolyhedronFilling() {
  sides_.reserve(set_table<3>[most]);
  qualities_.reserve(set_table<4>[most]);
}

bool PolyhedronFilling::find(const Polyhedron& polyhedron, const CellQuality& quality, double enough, std::size_t most_poor) {
  assert(polyhedron.points.size() >= 4 && polyhedron.points.size() <= most && polyhedron.faces.size() >= 4);
  given_ = &polyhedron;
  measure_ = &quality;
  bar_ = enough;
  most_poor_ = most_poor;
  nodes_ = 0;
  best_.clear();
  prepare();
  if (open_given_faces()) search(0, {});
  all_nodes_ += nodes_;
  return !best_.empty();
}

/// Numbers the points by their coordinates, and forgets what was known of others.
void PolyhedronFilling::prepare() {
  const Polyhedron& p = *given_;
  count_ = p.points.size();
  std::iota(given_number_.begin(), given_number_.begin() + count_, Index{0});
  std::sort(given_number_.begin(), given_number_.begin() + count_,
            [&p](Index i, Index j) { return lex_less<3>(p.points[i], p.points[j]); });
  for (std::size_t i = 0; i < count_; ++i) {
    number_[given_number_[i]] = static_cast<Index>(i);
    points_[i] = p.points[given_number_[i]];
  }
  double box = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(points_.begin(), points_.begin() + count_,
                                                 [axis](const Point3& a, const Point3& b) { return a[axis] < b[axis]; });
    box *= (*high)[axis] - (*low)[axis];
  }
  // A determinant is off by 1e-15 of the box at most, and there are some dozen.
  most_volume6_ = p.volume6 * (1 + 1e-9) + box * 1e-12;
  sides_.assign(set_table<3>[count_], { unknown_set, unknown_set });
  face_crossed_.assign(set_table<3>[count_], unknown);
  edge_crossed_.assign(set_table<2>[count_], unknown);
  qualities_.assign(set_table<4>[count_], -1);
  possible_.assign(set_table<4>[count_], unknown);
  apexes_.assign(2 * set_table<3>[count_], unknown_set);
  states_.assign(2 * set_table<3>[count_], Side::free);
}

/// False if no cell can stand on some face.
bool PolyhedronFilling::open_given_faces() {
  const Polyhedron& p = *given_;
  fronts_.clear();
  laid_.clear();
  walls_.clear();
  edges_.clear();
  flat_sets_.clear();
  linked_.fill(0);
  kept_ = 0;
  for (const auto& [given_a, given_b, given_c] : p.faces) {
    const Index a = number_[given_a], b = number_[given_b], c = number_[given_c];
    const Triple t = ascending(a, b, c);
    const std::size_t triple = number_of(t);
    const bool turned = (a < b) + (b < c) + (c < a) == 1;  // an odd permutation of ascending numbers
    fronts_.push_back({static_cast<FaceNumber>(2 * triple + turned), 0});
    kept_ |= bits(t);
    linked_[a] |= bit(b) | bit(c);
    linked_[b] |= bit(a) | bit(c);
    linked_[c] |= bit(a) | bit(b);
  }
  for (const auto& e : p.edges) {
    const Index a = number_[e[0]], b = number_[e[1]];
    edges_.push_back({a, b});
    linked_[a] |= bit(b);
    linked_[b] |= bit(a);
    kept_ |= bit(a) | bit(b);
  }
  for (const Index k : p.kept) kept_ |= bit(number_[k]);
  for (const Set given : p.flat_sets) {
    Set s = 0;
    for (std::size_t i = 0; i < count_; ++i)
      if (given >> i & 1) s |= bit(number_[i]);
    flat_sets_.push_back(s);
  }
  std::sort(fronts_.begin(), fronts_.end(), [](const OpenFace& f, const OpenFace& g) { return f.face < g.face; });
  for (const OpenFace& f : fronts_) states_[f.face] = Side::open;
  for (const OpenFace& f : fronts_) {
    if (states_[f.face ^ 1] == Side::free) states_[f.face ^ 1] = Side::taken;  // the outside
    if (walls_.empty() || walls_.back() != f.face / 2) walls_.push_back(f.face / 2);
  }
  return std::all_of(fronts_.begin(), fronts_.end(), [this](OpenFace& f) { return (f.apexes = apexes_left(f.face)) != 0; });
}

/// Which points are on which side of the plane of three points.
const PolyhedronFilling::Sides& PolyhedronFilling::sides(std::size_t triple) {
  Sides& s = sides_[triple];
  if (s.above != unknown_set) return s;
  const Triple& t = all_triples[triple];
  const detail::SideOfPlane plane(points_[t[0]], points_[t[1]], points_[t[2]]);
  s = {};
  for (std::size_t i = 0; i < count_; ++i) {
    if (i == t[0] || i == t[1] || i == t[2]) continue;
    const Sign sign = plane.of(points_[i]);
    if (sign == Sign::positive) s.above |= bit(static_cast<Index>(i));
    if (sign == Sign::negative) s.below |= bit(static_cast<Index>(i));
  }
  return s;
}

PolyhedronFilling::Set PolyhedronFilling::inner_side(FaceNumber f) {
  const Sides& s = sides(f / 2);
  return f & 1 ? s.below : s.above;
}

Simplex<3> PolyhedronFilling::simplex(const Quad& corners, bool turned) const {
  Simplex<3> s;
  for (int i = 0; i < 4; ++i) s[i] = points_[corners[i]];
  if (turned) std::swap(s[2], s[3]);
  return s;
}

/// The quality of a cell; 0 if it is in no filling. `turned`: its corners are in negative order.
double PolyhedronFilling::quality_of(const Quad& corners, bool turned) {
  double& q = qualities_[number_of(corners)];
  if (q >= 0) return q;
  const Set all = bits(corners);
  q = 0;
  for (const Set flat : flat_sets_)
    if (!(all & ~flat)) return q;
  const double measured = measure_->of(simplex(corners, turned), given_->region, bar_);
  if (measured > bar_) q = measured;
  return q;
}

/// Not if a point that has to stay is in the cell, or a given face or edge crosses it: no filling has it then.
bool PolyhedronFilling::may_be(const Quad& corners, bool turned) {
  std::uint8_t& known = possible_[number_of(corners)];
  if (known == unknown) known = !is_crossed(corners, turned);
  return known;
}

bool PolyhedronFilling::is_crossed(const Quad& corners, bool turned) {
  Set within = kept_ & ~bits(corners);
  for (int i = 0; i < 4 && within; ++i) {
    within &= ~inner_side(static_cast<FaceNumber>(face_of(corners, turned, i) ^ 1));
  }
  if (within) return true;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (edge_is_crossed(corners[i], corners[j])) return true;
  for (int i = 0; i < 4; ++i)
    if (face_is_crossed(number_of(face_opposite(corners, i)))) return true;
  return false;
}

bool PolyhedronFilling::edge_is_crossed(Index p, Index q) {
  if (linked_[p] & bit(q)) return false;
  std::uint8_t& known = edge_crossed_[number_of(std::array<Index, 2>{p, q})];
  if (known == unknown) known = std::any_of(walls_.begin(), walls_.end(), [&](std::size_t wall) { return crosses(p, q, wall); });
  return known;
}

bool PolyhedronFilling::face_is_crossed(std::size_t triple) {
  std::uint8_t& known = face_crossed_[triple];
  if (known != unknown) return known;
  known = false;
  if (states_[2 * triple] != Side::free && std::binary_search(walls_.begin(), walls_.end(), triple)) return false;
  const Sides& s = sides(triple);
  for (Set above = s.above; above && !known; above &= above - 1) {
    const auto p = static_cast<Index>(std::countr_zero(above));
    for (Set linked = linked_[p] & s.below; linked && !known; linked &= linked - 1)
      known = crosses(p, static_cast<Index>(std::countr_zero(linked)), triple);
  }
  return known;
}

/// Does the inner part of the edge meet the inner part of the triangle in one point?
bool PolyhedronFilling::crosses(Index p, Index q, std::size_t triple) {
  const Sides& s = sides(triple);
  const bool through = ((s.above & bit(p)) && (s.below & bit(q))) || ((s.below & bit(p)) && (s.above & bit(q)));
  if (!through) return false;
  const auto apart = [this, p, q](Index a, Index b, Index c) {
    const Sides& of_plane = sides(number_of(ascending(p, q, a)));
    return ((of_plane.above & bit(b)) && (of_plane.below & bit(c))) || ((of_plane.below & bit(b)) && (of_plane.above & bit(c)));
  };
  const auto& [a, b, c] = all_triples[triple];
  return apart(a, b, c) && apart(b, c, a);
}

/// The points that a cell on the face may have as its apex, whatever else is laid.
PolyhedronFilling::Set PolyhedronFilling::apexes_of(FaceNumber f) {
  Set& known = apexes_[f];
  if (known != unknown_set) return known;
  Set good = 0;
  for (Set left = inner_side(f); left; left &= left - 1) {
    const auto v = static_cast<Index>(std::countr_zero(left));
    const Placed cell = with_apex(f, v);
    if (quality_of(cell.corners, cell.turned) > bar_) good |= bit(v);
  }
  return apexes_[f] = good;
}

/// Those of them whose cells have no face that another cell has taken.
PolyhedronFilling::Set PolyhedronFilling::apexes_left(FaceNumber f) {
  Set good = 0;
  for (Set left = apexes_of(f); left; left &= left - 1) {
    const auto v = static_cast<Index>(std::countr_zero(left));
    const auto [corners, turned, place] = with_apex(f, v);
    bool fits = true;
    for (int i = 0; i < 4 && fits; ++i) fits = i == place || states_[face_of(corners, turned, i)] != Side::taken;
    if (fits) good |= bit(v);
  }
  return good;
}

/// True: there is no need to search on. The front is what is behind `front` in the list.
bool PolyhedronFilling::search(std::size_t front, const Filling& so_far) {
  const std::size_t end = fronts_.size();
  if (front == end) return accept(so_far);
  const auto fewer = [](const OpenFace& f, const OpenFace& g) { return std::popcount(f.apexes) < std::popcount(g.apexes); };
  const OpenFace on = *std::min_element(fronts_.begin() + front, fronts_.end(), fewer);
  std::array<Candidate, most_points> list;
  const std::size_t candidates = list_candidates(on, list);
  for (const Candidate& c : std::span(list).first(candidates)) {
    if (!(std::min(c.quality, so_far.least) > bar_)) return false;
    Filling next{std::min(c.quality, so_far.least), so_far.poor + (c.quality < 1), so_far.volume6};
    if (next.poor > most_poor_) return false;
    const Placed cell = with_apex(on.face, c.apex);
    const auto from = [&](int i) { return detail::difference<3>(points_[cell.corners[i]], points_[cell.corners[0]]); };
    next.volume6 += std::fabs(detail::dot(from(1), detail::cross(from(2), from(3))));
    if (next.volume6 > most_volume6_) continue;
    if (nodes_ == most_nodes) return true;
    ++nodes_;
    const bool alive = lay(cell.corners, cell.turned, front, end);
    if (alive && search(end, next)) return true;
    fronts_.resize(end);
    take_back();
  }
  return false;
}

/// Lists the cells that may stand on the face, the best first; of as good ones first what closes more faces.
std::size_t PolyhedronFilling::list_candidates(const OpenFace& on, std::array<Candidate, most_points>& list) {
  std::size_t n = 0;
  for (Set left = on.apexes; left; left &= left - 1) {
    const auto v = static_cast<Index>(std::countr_zero(left));
    const Placed cell = with_apex(on.face, v);
    const double q = qualities_[number_of(cell.corners)];
    if (!(q > bar_) || !may_be(cell.corners, cell.turned)) continue;
    int closes = 0;
    for (int i = 0; i < 4; ++i) closes += states_[face_of(cell.corners, cell.turned, i)] == Side::open;
    list[n++] = {q, closes, v};
  }
  std::sort(list.begin(), list.begin() + n, [](const Candidate& c, const Candidate& d) {
    if (c.quality != d.quality) return c.quality > d.quality;
    return c.closes != d.closes ? c.closes > d.closes : c.apex < d.apex;
  });
  return n;
}

/// Lays a cell, and lists the new front behind `end`. False if no cell can stand on some face of it.
bool PolyhedronFilling::lay(const Quad& cell, bool turned, std::size_t front, std::size_t end) {
  laid_.push_back({cell, turned});
  const Set corners = bits(cell);
  std::array<FaceNumber, 4> face;
  std::array<bool, 4> opens;
  for (int i = 0; i < 4; ++i) {
    face[i] = face_of(cell, turned, i);
    assert(states_[face[i]] != Side::taken);
    opens[i] = states_[face[i]] == Side::free;
    states_[face[i]] = Side::taken;
    if (opens[i]) states_[face[i] ^ 1] = Side::open;
  }
  bool alive = true;
  for (std::size_t k = front; k < end && alive; ++k) {
    OpenFace f = fronts_[k];
    if (states_[f.face] == Side::taken) continue;
    const Triple& t = all_triples[f.face / 2];
    const Set own = bits(t);
    // A cell on f that shares a face with the new one must be on the other side of it.
    if (std::popcount(own & corners) >= 2)
      for (int i = 0; i < 4; ++i) {
        const Set of_face = corners & ~bit(cell[i]), further = of_face & ~own;
        if (!(further & f.apexes) || std::popcount(further) != 1) continue;
        if (inner_side(face[i]) & own & ~of_face) f.apexes &= ~further;
      }
    alive = f.apexes != 0;
    fronts_.push_back(f);
  }
  const std::size_t opened = fronts_.size();
  for (int i = 0; i < 4 && alive; ++i)
    if (opens[i]) fronts_.push_back({static_cast<FaceNumber>(face[i] ^ 1), 0});
  for (std::size_t k = opened; k < fronts_.size() && alive; ++k) alive = (fronts_[k].apexes = apexes_left(fronts_[k].face)) != 0;
  return alive;
}

void PolyhedronFilling::take_back() {
  const auto [cell, turned] = laid_.back();
  laid_.pop_back();
  for (int i = 0; i < 4; ++i) {
    const FaceNumber f = face_of(cell, turned, i);
    Side& other = states_[f ^ 1];
    // What the cell opened is open still, as the cells behind it are gone; but a wall, or a face that was open, stays so.
    states_[f] = Side::open;
    if (other == Side::open && !std::binary_search(walls_.begin(), walls_.end(), static_cast<std::size_t>(f / 2)))
      states_[f] = other = Side::free;
  }
}

bool PolyhedronFilling::accept(const Filling& filling) {
  Set used = 0;
  std::array<Set, most_points> joined{};
  for (const auto& [cell, turned] : laid_) {
    const Set all = bits(cell);
    used |= all;
    for (const Index i : cell) joined[i] |= all;
  }
  if (kept_ & ~used) return false;
  for (const auto& [a, b] : edges_)
    if (!(joined[a] & bit(b))) return false;
  best_.clear();
  for (const auto& [cell, turned] : laid_) {
    Polyhedron::Cell out;
    for (int i = 0; i < 4; ++i) out[i] = given_number_[cell[i]];
    if (turned) std::swap(out[2], out[3]);
    best_.push_back(out);
  }
  bar_ = least_ = filling.least;
  return least_ >= 1;
}

}  // namespace pgdr
