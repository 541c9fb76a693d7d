// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What meets what, against clipping in rationals, pair by pair: many small random inputs with few coordinates, where
// degeneracy is common; the same scaled, and turned and rounded.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "domain_plcs.hpp"
#include "oracles.hpp"
#include "pgdr/diagnosis.hpp"

namespace pgdr {
namespace {

using oracle::Rational;
using Vector = std::array<Rational, 3>;
using Polygon = std::vector<Vector>;
using Pair = std::array<std::int64_t, 2>;
using Triple = std::array<std::int64_t, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// The part of a convex polygon (of one or two corners, too) where normal . (x - at) >= 0.
Polygon clip(const Polygon& polygon, const Vector& normal, const Vector& at) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational h = dot(normal, p - at), k = dot(normal, q - at);
    if (h >= 0) out.push_back(p);
    if (!((h > 0 && k < 0) || (h < 0 && k > 0))) continue;
    const Rational t = h / (h - k);
    out.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
  }
  return out;
}

Polygon clip_both(const Polygon& polygon, const Vector& normal, const Vector& at) {
  return clip(clip(polygon, normal, at), Vector{} - normal, at);
}

// The intersection of two simplices of 1 to 3 corners, by its corners and perhaps more of its points.
Polygon intersect(Polygon a, const Polygon& b) {
  if (b.size() == 1) {
    for (std::size_t i = 0; i < 3; ++i) {
      Vector axis{0, 0, 0};
      axis[i] = 1;
      a = clip_both(a, axis, b[0]);
    }
  } else if (b.size() == 2) {
    const Vector d = b[1] - b[0];
    for (std::size_t i = 0; i < 3; ++i) {
      Vector axis{0, 0, 0};
      axis[i] = 1;
      if (const Vector n = cross(d, axis); !is_zero(n)) a = clip_both(a, n, b[0]);
    }
    a = clip(clip(a, d, b[0]), Vector{} - d, b[1]);
  } else {
    const Vector n = cross(b[1] - b[0], b[2] - b[0]);
    a = clip_both(a, n, b[0]);
    for (std::size_t i = 0; i < 3; ++i) a = clip(a, cross(n, b[(i + 1) % 3] - b[i]), b[i]);
  }
  return a;
}

bool has_area(const Polygon& p) {
  for (std::size_t i = 2; i < p.size(); ++i)
    for (std::size_t j = 1; j < i; ++j)
      if (!is_zero(cross(p[j] - p[0], p[i] - p[0]))) return true;
  return false;
}

struct Findings {
  std::set<Pair> cross, overlap, segments_cross;
  std::set<Triple> segment_facet;  // the points of the segment, the facet
  std::set<Pair> on_facet;
  std::set<Triple> on_edge;
  friend bool operator==(const Findings&, const Findings&) = default;
};

struct Entity {
  std::vector<std::uint32_t> corners;
  std::int64_t facet = -1, segment = -1;
};

template <int D>
Vector lifted(const Point<D>& p) {
  if constexpr (D == 3) return {p[0], p[1], p[2]};
  else return {p[0], p[1], 0};
}

template <int D>
std::vector<Entity> simplices_of(const Domain<D>& d) {
  std::vector<Entity> out;
  std::set<std::uint32_t> used;
  if constexpr (D == 3)
    for (EntityId f = 0; f < d.facets().size(); ++f)
      for (std::size_t k = 0; k < d.triangles(f).size(); ++k) {
        const auto& t = d.triangles(f)[k];
        out.push_back({{t.begin(), t.end()}, d.triangle_origins(f)[k].facet});
        used.insert(t.begin(), t.end());
      }
  for (EntityId s = 0; s < d.segments().size(); ++s) {
    const auto& e = d.segments()[s].points;
    if (d.facets_of_segment(s).empty()) out.push_back({{e.begin(), e.end()}, -1, s});
    used.insert(e.begin(), e.end());
  }
  for (std::uint32_t v = 0; v < d.points().size(); ++v)
    if (!used.count(v)) out.push_back({{v}});
  return out;
}

template <int D>
class Oracle {
 public:
  explicit Oracle(const Domain<D>& domain) : d_(domain), simplices_(simplices_of(domain)) {
    for (std::size_t i = 0; i < simplices_.size(); ++i)
      for (std::size_t j = i + 1; j < simplices_.size(); ++j) look_at(simplices_[i], simplices_[j]);
  }
  const Findings& found() const { return found_; }

 private:
  Polygon at(const std::vector<std::uint32_t>& corners) const {
    Polygon out;
    for (const std::uint32_t v : corners) out.push_back(lifted<D>(d_.points()[v]));
    return out;
  }
  std::int64_t number(std::uint32_t v) const { return d_.input_of_point()[v]; }

  void look_at(const Entity& a, const Entity& b) {
    if (a.facet >= 0 && a.facet == b.facet) return;
    std::vector<std::uint32_t> shared;
    for (const std::uint32_t v : a.corners)
      if (std::count(b.corners.begin(), b.corners.end(), v)) shared.push_back(v);
    rest(a, b);
    rest(b, a);
    Polygon both = intersect(at(a.corners), at(b.corners));
    if (both.empty()) return;
    if (has_area(both)) {
      found_.overlap.insert({std::min(a.facet, b.facet), std::max(a.facet, b.facet)});
      return;
    }
    std::sort(both.begin(), both.end());
    Polygon corners = at(a.corners);
    for (const Vector& v : at(b.corners)) corners.push_back(v);
    const auto is_corner = [&](const Vector& v) { return std::find(corners.begin(), corners.end(), v) != corners.end(); };
    if (is_corner(both.front()) && is_corner(both.back())) return;
    if (a.facet >= 0 && b.facet >= 0) {
      found_.cross.insert({std::min(a.facet, b.facet), std::max(a.facet, b.facet)});
    } else if (a.facet >= 0 || b.facet >= 0) {
      const Entity &s = a.facet >= 0 ? b : a, &f = a.facet >= 0 ? a : b;
      found_.segment_facet.insert({number(s.corners[0]), number(s.corners[1]), f.facet});
    } else {
      found_.segments_cross.insert({std::min(a.segment, b.segment), std::max(a.segment, b.segment)});
    }
  }

  // Corners of a on b.
  void rest(const Entity& a, const Entity& b) {
    if (b.corners.size() == 1) return;
    for (const std::uint32_t v : a.corners) {
      if (std::count(b.corners.begin(), b.corners.end(), v) || intersect(at({v}), at(b.corners)).empty()) continue;
      bool on_edge = false;
      for (std::size_t i = 0; i < (b.corners.size() == 2 ? 1 : 3); ++i) {
        const std::uint32_t p = b.corners[i], q = b.corners[(i + 1) % b.corners.size()];
        if (intersect(at({v}), at({p, q})).empty()) continue;
        on_edge = true;
        found_.on_edge.insert({number(v), number(std::min(p, q)), number(std::max(p, q))});
      }
      if (!on_edge) found_.on_facet.insert({number(v), b.facet});
    }
  }

  const Domain<D>& d_;
  std::vector<Entity> simplices_;
  Findings found_;
};

template <int D>
Findings found_by(const Diagnosis<D>& d, const Domain<D>& domain) {
  Findings out;
  for (const auto& i : d[Finding::facets_cross].listed) out.cross.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::facets_overlap].listed) out.overlap.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::segment_crosses_facet].listed)
    out.segment_facet.insert({i.what.ids[0], i.what.ids[1], i.what.ids[2]});
  const auto segment = [&](std::int64_t p, std::int64_t q) -> std::int64_t {
    return test::find_segment(domain, domain.point_of_input()[static_cast<std::size_t>(p)],
                              domain.point_of_input()[static_cast<std::size_t>(q)]);
  };
  for (const auto& i : d[Finding::segments_cross].listed)
    out.segments_cross.insert({segment(i.what.ids[0], i.what.ids[1]), segment(i.what.ids[2], i.what.ids[3])});
  for (const auto& i : d[Finding::point_on_facet].listed) out.on_facet.insert({i.what.ids[0], i.what.ids[1]});
  for (const auto& i : d[Finding::point_on_segment].listed)
    out.on_edge.insert({i.what.ids[0], i.what.ids[1], i.what.ids[2]});
  return out;
}

struct Tally {
  int valid = 0, cross = 0, overlap = 0, segment_facet = 0, segments = 0, on_facet = 0, on_edge = 0, inner_edges = 0;
};

template <int D>
void compare(const Plc<D>& plc, Tally& tally) {
  std::vector<Diagnostic> refused;
  const Domain<D> domain = Domain<D>::without_invalid(plc, refused);
  const Diagnosis<D> diagnosis = diagnose(plc, {.most_listed = 1000000});
  const Findings expected = Oracle<D>(domain).found(), found = found_by(diagnosis, domain);
  EXPECT_EQ(diagnosis[Finding::invalid_entity].count, refused.size());
  ASSERT_EQ(found.cross, expected.cross);
  ASSERT_EQ(found.overlap, expected.overlap);
  ASSERT_EQ(found.segment_facet, expected.segment_facet);
  ASSERT_EQ(found.segments_cross, expected.segments_cross);
  ASSERT_EQ(found.on_facet, expected.on_facet);
  ASSERT_EQ(found.on_edge, expected.on_edge);
  tally.valid += expected == Findings{};
  tally.cross += !expected.cross.empty();
  tally.overlap += !expected.overlap.empty();
  tally.segment_facet += !expected.segment_facet.empty();
  tally.segments += !expected.segments_cross.empty();
  EXPECT_TRUE(expected.on_facet.empty() && expected.on_edge.empty());  // the Domain has repaired these
  for (const Diagnostic& repair : domain.repairs()) {
    tally.on_facet += repair.code == Errc::point_on_facet;
    tally.on_edge += repair.code == Errc::point_on_segment;
    tally.inner_edges += repair.code == Errc::entities_intersect;
  }
}

// On the grid {0 .. steps}^D; points distinct.
template <int D>
Plc<D> random_plc(std::mt19937_64& random, int steps) {
  const auto pick = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
  Plc<D> plc;
  const std::size_t points = 4 + pick(6);
  std::set<std::array<double, D>> taken;
  while (plc.points.size() < points) {
    Point<D> p;
    for (double& x : p.x) x = pick(static_cast<std::size_t>(steps) + 1);
    if (taken.insert(p.x).second) plc.points.push_back(p);
  }
  const auto distinct = [&](std::size_t n) {
    std::vector<std::uint32_t> v;
    while (v.size() < n)
      if (const std::uint32_t i = pick(points); !std::count(v.begin(), v.end(), i)) v.push_back(i);
    return v;
  };
  if constexpr (D == 3) {
    for (std::uint32_t k = pick(5); k-- > 0;) plc.facets.push_back({{distinct(3)}, {}, static_cast<int>(pick(2))});
    std::vector<std::uint32_t> level;  // a polygon of one plane; some of them cross themselves
    for (std::uint32_t v = 0; v < points; ++v)
      if (plc.points[v][2] == 1) level.push_back(v);
    if (level.size() > 3 && pick(2) == 0) plc.facets.push_back({{level}, {}, 0});
  }
  for (std::uint32_t k = pick(6); k-- > 0;) {
    const auto e = distinct(2);
    plc.segments.push_back({{e[0], e[1]}, 0});
  }
  return plc;
}

TEST(DiagnosisOracle, SpaceWithFewCoordinates) {
  std::mt19937_64 random(oracle::seed());
  Tally tally;
  for (int k = 0; k < 10000 && !HasFatalFailure(); ++k) compare(random_plc<3>(random, 2), tally);
  for (const int n : {tally.valid, tally.cross, tally.overlap, tally.segment_facet, tally.segments, tally.on_facet,
                      tally.on_edge})
    EXPECT_GT(n, 30);
  EXPECT_GT(tally.inner_edges, 10);
}

TEST(DiagnosisOracle, PlaneWithFewCoordinates) {
  std::mt19937_64 random(oracle::seed() + 1);
  Tally tally;
  for (int k = 0; k < 4000 && !HasFatalFailure(); ++k) compare(random_plc<2>(random, 3), tally);
  for (const int n : {tally.valid, tally.segments, tally.on_edge}) EXPECT_GT(n, 100);
}

TEST(DiagnosisOracle, ScaledAndTurned) {
  std::mt19937_64 random(oracle::seed() + 2);
  Tally tally;
  for (int k = 0; k < 500 && !HasFatalFailure(); ++k) {
    Plc<3> plc = random_plc<3>(random, 2);
    compare(test::turned(plc), tally);
    if (HasFatalFailure()) return;
    for (const double factor : {0x1p-200, 0.1, 0x1p300}) {
      Plc<3> scaled = plc;
      for (Point3& p : scaled.points)
        for (double& x : p.x) x *= factor;
      compare(scaled, tally);
    }
  }
}

}  // namespace
}  // namespace pgdr
