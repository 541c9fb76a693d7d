// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the geometry layer must agree with: determinants, circumspheres and perturbed signs in rationals, straight from
// their definitions and by other formulas than the library's (homogeneous matrices, Gaussian elimination); and families of
// random points with manufactured degeneracy. Slow, tests only.
#pragma once

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::oracle {

using Rational = CGAL::Exact_rational;

inline Sign sign(const Rational& q) { return sign_of(q.sign()); }
inline int to_int(Sign s) { return static_cast<int>(s); }
inline Sign times(Sign a, Sign b) { return static_cast<Sign>(to_int(a) * to_int(b)); }

/// Of the random numbers of a test program: from the environment variable PGDR_TEST_SEED if set; printed once.
inline std::uint64_t seed() {
  static const std::uint64_t value = [] {
    const char* text = std::getenv("PGDR_TEST_SEED");
    const std::uint64_t v = text ? std::strtoull(text, nullptr, 10) : 20260601;
    std::cout << "PGDR_TEST_SEED=" << v << '\n';
    return v;
  }();
  return value;
}

template <std::size_t N>
using Square = std::array<std::array<Rational, N>, N>;

/// By Gaussian elimination.
template <std::size_t N>
Rational determinant(Square<N> m) {
  Rational det = 1;
  for (std::size_t c = 0; c < N; ++c) {
    std::size_t pivot = c;
    while (pivot < N && m[pivot][c].sign() == 0) ++pivot;
    if (pivot == N) return 0;
    if (pivot != c) {
      std::swap(m[pivot], m[c]);
      det = -det;
    }
    det *= m[c][c];
    for (std::size_t r = c + 1; r < N; ++r) {
      if (m[r][c].sign() == 0) continue;
      const Rational factor = m[r][c] / m[c][c];
      for (std::size_t k = c; k < N; ++k) m[r][k] -= factor * m[c][k];
    }
  }
  return det;
}

template <int D>
Rational squared_norm(const Point<D>& p) {
  Rational sum = 0;
  for (const double x : p.x) sum += Rational(x) * Rational(x);
  return sum;
}

template <int D>
Rational squared_distance(const std::array<Rational, D>& a, const Point<D>& b) {
  Rational sum = 0;
  for (std::size_t i = 0; i < D; ++i) sum += (a[i] - Rational(b.x[i])) * (a[i] - Rational(b.x[i]));
  return sum;
}

template <int D>
std::array<Rational, D> exact(const Point<D>& p) {
  std::array<Rational, D> q;
  for (std::size_t i = 0; i < D; ++i) q[i] = p.x[i];
  return q;
}

/// det of the rows (1, x_i), which is det[x_1 - x_0; ...].
template <int D>
Rational orient_det(const Simplex<D>& s) {
  Square<D + 1> m;
  for (std::size_t i = 0; i <= D; ++i) {
    m[i][0] = 1;
    for (std::size_t k = 0; k < D; ++k) m[i][k + 1] = s[i].x[k];
  }
  return determinant<D + 1>(m);
}

template <int D>
Sign orient(const Simplex<D>& s) {
  return sign(orient_det<D>(s));
}

/// Minus the determinant of the rows (1, x_i, h_i): positive where p (the last) is below the plane of the lifted rest,
/// if these are positively oriented.
template <int D, std::size_t N>
Rational lifted_det(const std::array<Point<D>, N>& points, const std::array<Rational, N>& heights) {
  static_assert(N == D + 2);
  Square<N> m;
  for (std::size_t i = 0; i < N; ++i) {
    m[i][0] = 1;
    for (std::size_t k = 0; k < D; ++k) m[i][k + 1] = points[i].x[k];
    m[i][D + 1] = heights[i];
  }
  return -determinant<N>(m);
}

/// Heights |x|^2 + eps with honest little numbers 2^-(400 * 4^rank): smaller than any ratio of the cofactors of
/// coordinates between, say, 2^-60 and 2^60, and each far smaller than all products of those before it.
template <class P, std::size_t N>
std::array<Rational, N> heights(const std::array<P, N>& points, bool perturbed) {
  std::array<Rational, N> h;
  for (std::size_t i = 0; i < N; ++i) {
    h[i] = squared_norm(points[i]);
    unsigned rank = 0;
    for (const P& q : points) rank += lex_less(q, points[i]);
    if (perturbed) h[i] += Rational(1) / Rational(boost::multiprecision::mpz_int(1) << (400u << (2 * rank)));
  }
  return h;
}

template <int D>
Sign in_sphere(const Simplex<D>& s, const Point<D>& p, bool perturbed = false) {
  std::array<Point<D>, D + 2> all;
  std::copy(s.begin(), s.end(), all.begin());
  all[D + 1] = p;
  return sign(lifted_det<D, D + 2>(all, heights(all, perturbed)));
}

/// In-circle of four points of space without the coordinate `axis`, but with heights of all three.
inline Sign in_circle(const std::array<Point3, 4>& p, int axis, bool perturbed) {
  std::array<Point2, 4> flat;
  for (std::size_t i = 0; i < 4; ++i) flat[i] = {{p[i][(axis + 1) % 3], p[i][(axis + 2) % 3]}};
  return sign(lifted_det<2, 4>(flat, heights(p, perturbed)));
}

/// Circumcentre and squared radius, from 2 (x_i - x_0) . c = |x_i|^2 - |x_0|^2 by Cramer's rule.
template <int D>
struct ExactSphere {
  std::array<Rational, D> center;
  Rational squared_radius;
};

template <int D>
ExactSphere<D> circumsphere(const Simplex<D>& s) {
  Square<D> m;
  std::array<Rational, D> right;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t k = 0; k < D; ++k) m[i][k] = 2 * (Rational(s[i + 1].x[k]) - Rational(s[0].x[k]));
    right[i] = squared_norm(s[i + 1]) - squared_norm(s[0]);
  }
  const Rational det = determinant<D>(m);
  ExactSphere<D> result;
  for (std::size_t k = 0; k < D; ++k) {
    Square<D> column = m;
    for (std::size_t i = 0; i < D; ++i) column[i][k] = right[i];
    result.center[k] = determinant<D>(column) / det;
  }
  result.squared_radius = squared_distance<D>(result.center, s[0]);
  return result;
}

template <int D>
Rational shortest_edge_squared(const Simplex<D>& s) {
  Rational shortest = -1;
  for (std::size_t i = 0; i <= D; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Rational l = squared_distance<D>(exact<D>(s[i]), s[j]);
      if (shortest.sign() < 0 || l < shortest) shortest = l;
    }
  return shortest;
}

using Random = std::mt19937_64;

inline double uniform(Random& r) { return std::ldexp(static_cast<double>(r() >> 11), -53); }
inline int below(Random& r, int n) { return static_cast<int>(r() % static_cast<std::uint64_t>(n)); }

/// Up or down by one ulp, or not, each as often.
inline double nudged(Random& r, double x) {
  const int k = below(r, 3);
  return k == 0 ? x : std::nextafter(x, k == 1 ? HUGE_VAL : -HUGE_VAL);
}

template <int D>
struct Family {
  std::string name;
  std::function<Point<D>(Random&)> point;
  bool tame = true;  ///< honest little numbers work, see `heights`
};

template <int D, class F>
Point<D> each(F f) {
  Point<D> p;
  for (double& x : p.x) x = f();
  return p;
}

/// On a sphere about the origin exactly: all of |x|^2 = 81 resp. 65^2 up to the order and signs of coordinates.
template <int D>
Point<D> on_sphere(Random& r) {
  static const std::vector<std::vector<double>> space{{1, 4, 8}, {4, 4, 7}, {3, 6, 6}, {0, 0, 9}};
  static const std::vector<std::vector<double>> plane{{16, 63}, {33, 56}, {25, 60}, {39, 52}, {0, 65}};
  std::vector<double> x = D == 3 ? space[r() % space.size()] : plane[r() % plane.size()];
  std::shuffle(x.begin(), x.end(), r);
  Point<D> p;
  for (std::size_t i = 0; i < D; ++i) p.x[i] = r() % 2 ? x[i] : -x[i];
  return p;
}

/// Coplanar in a plane that is not parallel to an axis (collinear in 2D).
template <int D>
Point<D> on_plane(Random& r) {
  Point<D> p = each<D>([&] { return below(r, 7) - 3; });
  p.x[D - 1] = D == 3 ? 2 * p.x[0] - 3 * p.x[1] + 1 : 3 * p.x[0] - 1;
  return p;
}

template <int D>
std::vector<Family<D>> families() {
  const auto scaled = [](Point<D> p, int k) {
    for (double& x : p.x) x = std::ldexp(x, k);
    return p;
  };
  const auto grid = [](Random& r) { return each<D>([&] { return below(r, 4); }); };
  const auto tenths = [](Random& r) { return each<D>([&] { return 0.1 * below(r, 5); }); };
  const auto random = [](Random& r) { return each<D>([&] { return uniform(r); }); };
  const auto nudge = [](Random& r, Point<D> p) {
    for (double& x : p.x) x = nudged(r, x);
    return p;
  };
  return {
      {"uniform", random},
      {"grid", grid},
      {"grid of tenths", tenths},
      {"grid of tenths, shifted", [](Random& r) { return each<D>([&] { return 1e6 + 0.1 * below(r, 4); }); }},
      {"nudged grid", [=](Random& r) { return nudge(r, tenths(r)); }, false},
      {"sphere", on_sphere<D>},
      {"nudged sphere", [=](Random& r) { return nudge(r, on_sphere<D>(r)); }, false},
      {"plane", on_plane<D>},
      {"nudged plane", [=](Random& r) { return nudge(r, on_plane<D>(r)); }, false},
      {"uniform, 1e-250", [=](Random& r) { return scaled(random(r), -830); }, false},
      {"sphere, 1e-250", [=](Random& r) { return scaled(on_sphere<D>(r), -830); }, false},
      {"nudged sphere, 1e-60", [=](Random& r) { return scaled(nudge(r, on_sphere<D>(r)), -200); }, false},
      // Products of D resp. D+2 coordinates are fractions of the least denormal.
      {"underflowing minors",
       [=](Random& r) {
         Point<D> p = each<D>([&] { return std::ldexp(below(r, 8), D == 3 ? -538 : -269); });
         if (D == 3) p[2] = below(r, 8);
         return p;
       },
       false},
      {"underflowing determinants",
       [=](Random& r) { return each<D>([&] { return std::ldexp(below(r, 8), D == 3 ? -216 : -270); }); }, false},
      {"uniform, 1e140", [=](Random& r) { return scaled(random(r), 465); }, false},
      {"sphere, 1e140", [=](Random& r) { return scaled(on_sphere<D>(r), 465); }, false},
      {"sphere, overflowing", [=](Random& r) { return scaled(on_sphere<D>(r), 1016); }, false},
      {"denormal", [=](Random& r) { return scaled(on_sphere<D>(r), -1074); }, false},
      {"all magnitudes", [](Random& r) { return each<D>([&] { return std::ldexp(uniform(r) - 0.5, below(r, 1200) - 600); }); },
       false},
      {"grid beside dust",
       [](Random& r) { return each<D>([&] { return below(r, 3) + (r() % 4 ? 0 : std::ldexp(uniform(r), -60)); }); }, false},
  };
}

}  // namespace pgdr::oracle
