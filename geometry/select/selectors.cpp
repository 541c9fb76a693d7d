// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/selectors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/error.hpp"
#include "select/off_center.hpp"

namespace pgdr {
namespace {

using detail::difference;
using detail::Vector;

template <int D>
double length(const Vector<D>& v) {
  return std::sqrt(detail::dot(v, v));
}

template <int D>
Point<D> moved(const Point<D>& p, double s, const std::type_identity_t<Vector<D>>& v) {
  Point<D> q;
  for (int i = 0; i < D; ++i) q[i] = p[i] + s * v[i];
  return q;
}

void require(bool ok, const char* what) {
  if (!ok) throw UsageError({Errc::bad_option, what, {}, 0, {}, {}});
}

/// The shortest edge, the first in lexicographic order of its ends among equals; its midpoint, and from there the unit
/// vector towards the circumcentre and how far that is.
template <int D>
struct Axis {
  Vector<D> edge, direction{};
  Point<D> middle;
  double to_center = 0;

  explicit Axis(const PoorElement<D>& e) {
    int a = 0, b = 1;
    double least = squared_distance(e.corners[0], e.corners[1]);
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (const double d = squared_distance(e.corners[i], e.corners[j]); d < least) {
          least = d;
          a = i;
          b = j;
        }
    edge = difference(e.corners[b], e.corners[a]);
    middle = moved(e.corners[a], 0.5, edge);
    direction = difference(e.circumcenter, middle);
    to_center = length<D>(direction);
    if (to_center > 0)
      for (double& x : direction) x /= to_center;
  }
};

/// How far from the midpoint of the shortest edge the off-centre lies; nothing if the circumcentre is to be taken.
template <int D>
double off_center_distance(const PoorElement<D>& e, const Axis<D>& axis, double factor) {
  return std::min(detail::off_center_distance(factor, e.shortest_edge, e.radius_edge_bound), axis.to_center);
}

template <int D>
Point<D> off_center_of(const PoorElement<D>& e, double factor) {
  const Axis<D> axis(e);
  const double far = off_center_distance(e, axis, factor);
  if (far >= axis.to_center) return e.circumcenter;
  const Point<D> p = moved(axis.middle, far, axis.direction);
  if (inside(e.disk, p)) return p;
  constexpr double just = 1 - 0x1p-10;  // of an open disk
  const Point<D> q = moved(e.circumcenter, -just * e.disk.radius, axis.direction);
  return inside(e.disk, q) ? q : e.circumcenter;
}

/// Keeps the candidate that deletes the fewest good cells less poor ones; the first of equals. One in whose place an entity
/// would be split does not delete what it is credited with: it is kept only if all are.
template <int D>
class LeastLoss {
 public:
  LeastLoss(Neighborhood<D>& n, const Point<D>& otherwise) : neighborhood_(&n), best_(otherwise) {}

  /// False once there is no answer.
  bool offer(const Point<D>& p) {
    const Preview<D> preview = neighborhood_->count(p);
    if (preview.status == Preview<D>::Status::unknown) return false;
    if (preview.status == Preview<D>::Status::impossible) return true;
    const std::pair loss(preview.status == Preview<D>::Status::encroaches, preview.good - preview.poor);
    if (any_ && loss >= least_) return true;
    any_ = true;
    least_ = loss;
    best_ = p;
    return true;
  }
  const Point<D>& best() const { return best_; }

 private:
  Neighborhood<D>* neighborhood_;
  Point<D> best_;
  bool any_ = false;
  std::pair<bool, int> least_;
};

constexpr double arc_factor = 0.999;  // so that rounding leaves the new triangle within the bound

/// On the arc Gamma, a circle of radius R about a, the point at angle 2 atan(t) from the off-centre.
Point2 best_on_arc(const PoorElement<2>& e, Neighborhood<2>& neighborhood, int samples) {
  const Axis<2> axis(e);
  const double l = e.shortest_edge;
  const double h = off_center_distance(e, axis, arc_factor);
  if (!(e.disk.radius > 0) || !(h > 0)) return e.circumcenter;
  LeastLoss<2> best(neighborhood, e.circumcenter);
  const double radius = (h * h + l * l / 4) / (2 * h);
  const Point2 a = moved(axis.middle, h - radius, axis.direction);
  const double s = axis.to_center - (h - radius);  // from a to the circumcentre
  // Where the arc leaves the disk: the cosine of the angle there, and from it t.
  const double cosine = (s * s + radius * radius - e.disk.radius * e.disk.radius) / (2 * s * radius);
  if (cosine >= 1) return off_center_of<2>(e, arc_factor);
  const double most = std::sqrt((1 - cosine) / (1 + std::max(cosine, -0.5)));
  const Vector<2> across{-axis.direction[1], axis.direction[0]};
  const double side = across[0] * axis.edge[0] + across[1] * axis.edge[1] < 0 ? -1 : 1;
  const int pairs = samples / 2;
  for (int i = 0; i < samples; ++i) {
    const int step = (i + 1) / 2;
    const double t = (i % 2 ? side : -side) * most * step / (pairs + 1);
    const double c = (1 - t * t) / (1 + t * t), d = 2 * t / (1 + t * t);
    const Point2 p = moved(moved(a, radius * c, axis.direction), radius * d, across);
    if (inside(e.disk, p) && !best.offer(p)) break;
  }
  return best.best();
}

/// sin(pi x / 2) for 0 <= x <= 1, to some 1e-9: a sample's place need be no better.
double sine(double x) {
  const double y = x * 1.5707963267948966, z = y * y;
  return y * (1 + z * (-1. / 6 + z * (1. / 120 + z * (-1. / 5040 + z * (1. / 362880 - z / 39916800)))));
}

/// (cos, sin) of `turn` full turns, 0 <= turn < 1.
std::array<double, 2> on_circle(double turn) {
  const double quarters = 4 * turn;
  const int q = static_cast<int>(quarters);
  const double s = sine(quarters - q), c = sine(1 - (quarters - q));
  switch (q) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

/// Points of the open unit ball, uniform in spherical coordinates, from the centre outwards.
std::vector<Vector<3>> spherical_samples(int samples) {
  // Additive recurrences by powers of the inverse of the plastic number fill the square of the two angles evenly.
  constexpr double step[2] = {0.7548776662466927, 0.5698402909980532};
  std::vector<Vector<3>> unit;
  for (int i = 0; i < samples; ++i) {
    double turn[2];
    for (int k = 0; k < 2; ++k) turn[k] = 0.5 + step[k] * i - std::floor(0.5 + step[k] * i);
    const auto polar = on_circle(turn[0] / 2), azimuth = on_circle(turn[1]);
    const double r = (i + 0.5) / samples;
    unit.push_back({r * polar[1] * azimuth[0], r * polar[1] * azimuth[1], r * polar[0]});
  }
  return unit;
}

Point3 best_in_ball(const PoorElement<3>& e, Neighborhood<3>& neighborhood, const std::vector<Vector<3>>& unit) {
  if (!(e.disk.radius > 0)) return e.circumcenter;
  LeastLoss<3> best(neighborhood, e.circumcenter);
  if (!best.offer(e.circumcenter)) return e.circumcenter;
  for (const Vector<3>& v : unit) {
    const Point3 p = moved(e.disk.center, e.disk.radius, v);
    if (inside(e.disk, p) && !best.offer(p)) break;
  }
  return best.best();
}

/// Numbers in [-1, 1) from the shape of an element: its corners in units of a power of two of the order of its radius.
template <int D>
class Draw {
 public:
  explicit Draw(const PoorElement<D>& e, std::uint32_t seed = 0) : state_(0x9e3779b97f4a7c15 ^ seed) {
    const int exponent = -std::ilogb(e.circumradius);
    for (const Point<D>& p : e.corners)
      for (int i = 0; i < D; ++i) state_ = mix(state_ ^ std::bit_cast<std::uint64_t>(std::scalbn(p[i], exponent) + 0.0));
  }
  double next() {
    state_ += 0x9e3779b97f4a7c15;
    return static_cast<double>(mix(state_) >> 11) * 0x1p-52 - 1;
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {  // the finalizer of SplitMix64 (Steele, Lea, Flood 2014)
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// A point of the disk, uniformly; by rejection, so that it may fail, as it does where the disk is too small for its doubles.
template <int D>
bool draw_in(const SelectionDisk<D>& disk, Draw<D>& draw, Point<D>& p) {
  for (int tries = 0; tries < 64; ++tries) {
    Vector<D> v;
    for (double& x : v) x = draw.next();
    p = moved(disk.center, disk.radius, v);
    if (inside(disk, p)) return true;
  }
  return false;
}

template <int D>
Point<D> sharpest_avoided(const PoorElement<D>& e, Neighborhood<D>& neighborhood, int candidates) {
  if (!(e.disk.radius > 0)) return e.circumcenter;
  Draw<D> draw(e);
  Point<D> best = e.circumcenter, p = best;
  double least = 2;
  for (int i = 0; i <= candidates; ++i) {
    if (i > 0 && !draw_in(e.disk, draw, p)) continue;
    const Preview<D> preview = neighborhood.measure(p);
    if (preview.status == Preview<D>::Status::unknown) break;
    if (preview.status != Preview<D>::Status::possible || preview.sharpest_cosine >= least) continue;
    least = preview.sharpest_cosine;
    best = p;
  }
  return best;
}

template <int D>
Point<D> drawn(const PoorElement<D>& e, std::uint32_t seed) {
  if (!(e.disk.radius > 0)) return e.circumcenter;
  Draw<D> draw(e, seed);
  Point<D> p;
  return draw_in(e.disk, draw, p) ? p : e.circumcenter;
}

constexpr int most_samples = 1000000;

}  // namespace

template <int D>
PointSelector<D> off_center(double factor) {
  require(factor > 0 && std::isfinite(factor), "the factor of off-centres must be positive");
  return [factor](const PoorElement<D>& e) { return off_center_of<D>(e, factor); };
}

template <int D>
PointSelector<D> optimized(int samples) {
  require(samples >= 1 && samples <= most_samples, "the number of samples must lie between 1 and 1000000");
  if constexpr (D == 2) {
    return [samples](const PoorElement<2>& e, Neighborhood<2>& n) { return best_on_arc(e, n, samples); };
  } else {
    return [unit = spherical_samples(samples)](const PoorElement<3>& e, Neighborhood<3>& n) { return best_in_ball(e, n, unit); };
  }
}

template <int D>
PointSelector<D> sliver_avoiding(int candidates) {
  require(candidates >= 1 && candidates <= most_samples, "the number of candidates must lie between 1 and 1000000");
  return [candidates](const PoorElement<D>& e, Neighborhood<D>& n) { return sharpest_avoided<D>(e, n, candidates); };
}

template <int D>
PointSelector<D> randomized(std::uint32_t seed) {
  return [seed](const PoorElement<D>& e) { return drawn<D>(e, seed); };
}

template <int D>
PointSelector<D> default_selector() {
  if constexpr (D == 2) return off_center<2>();
  return {};
}

template PGDR_API PointSelector<2> default_selector<2>();
template PGDR_API PointSelector<3> default_selector<3>();
template PGDR_API PointSelector<2> off_center<2>(double);
template PGDR_API PointSelector<3> off_center<3>(double);
template PGDR_API PointSelector<2> optimized<2>(int);
template PGDR_API PointSelector<3> optimized<3>(int);
template PGDR_API PointSelector<2> sliver_avoiding<2>(int);
template PGDR_API PointSelector<3> sliver_avoiding<3>(int);
template PGDR_API PointSelector<2> randomized<2>(std::uint32_t);
template PGDR_API PointSelector<3> randomized<3>(std::uint32_t);

}  // namespace pgdr
