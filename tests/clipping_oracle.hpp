// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What meets what in an input, found by clipping in rationals, pair by pair: slow, and of other means than diagnosis.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "oracles.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::clipping {

using oracle::Rational;
using Vector = std::array<Rational, 3>;
using Polygon = std::vector<Vector>;
using Pair = std::array<std::int64_t, 2>;
using Triple = std::array<std::int64_t, 3>;

inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// The part of a convex polygon (of one or two corners, too) where normal . (x - at) >= 0.
inline Polygon clip(const Polygon& polygon, const Vector& normal, const Vector& at) {
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

inline Polygon clip_both(const Polygon& polygon, const Vector& normal, const Vector& at) {
  return clip(clip(polygon, normal, at), Vector{} - normal, at);
}

// The intersection of two simplices of 1 to 3 corners, by its corners and perhaps more of its points.
inline Polygon intersect(Polygon a, const Polygon& b) {
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

inline bool has_area(const Polygon& p) {
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
  if constexpr (D == 3)
    return {p[0], p[1], p[2]};
  else
    return {p[0], p[1], 0};
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

}  // namespace pgdr::clipping
