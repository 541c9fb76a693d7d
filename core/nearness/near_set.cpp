// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "nearness/near_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "given/cover.hpp"
#include "numbers/double_double.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::checking {
namespace {

using detail::difference;
using detail::dot;
using detail::DoubleDouble;
using Vector3 = detail::Vector<3>;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A point a + s (b - a) + t (c - a) of a triangle: s, t >= 0, s + t <= 1.
struct Foot {
  double s = 0, t = 0, square = infinite;  // and the squared distance from it
};

double clamped(double along, double length) { return length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0; }

/// With its longest edge first.
Triangle3 turned(const Triangle3& t) {
  const double a = squared_distance(t[0], t[1]), b = squared_distance(t[1], t[2]), c = squared_distance(t[2], t[0]);
  if (a >= b && a >= c) return t;
  return b >= c ? Triangle3{t[1], t[2], t[0]} : Triangle3{t[2], t[0], t[1]};
}

/// Whatever rounding does to s and t, they name a point of the triangle: so the distance from that is never too small by more
/// than the rounding of three differences and their sum. The part of v square to the longest edge tells t; so of a needle, too,
/// the point is as near as others but for rounding. @pre the triangle is turned
Foot nearest_foot(const Point3& x, const Triangle3& triangle) {
  const Vector3 u = difference(triangle[1], triangle[0]), v = difference(triangle[2], triangle[0]);
  const Vector3 w = difference(x, triangle[0]);
  Foot best;
  const auto take = [&](double s, double t) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double off = w[i] - (s * u[i] + t * v[i]);
      square += off * off;
    }
    if (square < best.square) best = {s, t, square};
  };
  const double uu = dot(u, u);
  if (!(uu > 0)) {
    take(0, 0);
    return best;
  }
  Vector3 across = v;
  for (int twice = 0; twice < 2; ++twice) {  // the second time for what rounding left
    const double along = dot(across, u) / uu;
    for (std::size_t i = 0; i < 3; ++i) across[i] -= along * u[i];
  }
  const double height = dot(across, across), t = height > 0 ? dot(w, across) / height : -1;
  if (t >= 0 && t <= 1) {
    Vector3 rest = w;
    for (std::size_t i = 0; i < 3; ++i) rest[i] -= t * v[i];
    const double s = dot(rest, u) / uu;
    if (s >= 0 && s + t <= 1) take(s, t);
  }
  take(clamped(dot(w, u), uu), 0);
  take(0, clamped(dot(w, v), dot(v, v)));
  const Vector3 third = difference(triangle[2], triangle[1]);
  const double on_third = clamped(dot(difference(x, triangle[1]), third), dot(third, third));
  take(1 - on_third, on_third);
  return best;
}

DoubleDouble exact_square(const Point3& x, const Triangle3& triangle, const Foot& foot) {
  DoubleDouble sum;
  for (int i = 0; i < 3; ++i) {
    const DoubleDouble off = detail::difference(x[i], triangle[0][i]) -
                             (DoubleDouble(foot.s) * detail::difference(triangle[1][i], triangle[0][i]) +
                              DoubleDouble(foot.t) * detail::difference(triangle[2][i], triangle[0][i]));
    sum = sum + off * off;
  }
  return sum;
}

/// By how much the root of a Foot's square may be off: each coordinate has rounded by no more than 4 times 2^-53 of the longest
/// of three differences.
double rounding_of(const Point3& x, const Triangle3& triangle) {
  double longest = 0;
  for (int i = 0; i < 3; ++i)
    longest = std::max({longest, std::abs(x[i] - triangle[0][i]), std::abs(triangle[1][i] - triangle[0][i]),
                        std::abs(triangle[2][i] - triangle[0][i])});
  return 0x1p-49 * longest;
}

template <std::size_t N>
Point3 centroid(const std::array<Point3, N>& piece) {
  Point3 c{};
  for (const Point3& p : piece)
    for (int i = 0; i < 3; ++i) c[i] += p[i] / static_cast<double>(N);
  return c;
}

Point3 middle(const Point3& a, const Point3& b) {
  Point3 m;
  for (int i = 0; i < 3; ++i) m[i] = a[i] / 2 + b[i] / 2;
  return m;
}

}  // namespace

double squared_distance_above(const Point3& x, const Triangle3& triangle) { return nearest_foot(x, turned(triangle)).square; }

bool is_within(const Point3& x, const Triangle3& given, double limit) {
  const Triangle3 triangle = turned(given);
  const Foot foot = nearest_foot(x, triangle);
  const double off = rounding_of(x, triangle);  // of the foot beside the nearest point, so that its square is what counts
  const double distance = std::sqrt(foot.square), slack = std::max(off, 0x1p-40 * limit);
  if (distance <= limit - slack) return true;
  if (!(distance <= limit + slack)) return false;
  const DoubleDouble rest = exact_square(x, triangle, foot) - DoubleDouble(limit) * DoubleDouble(limit);
  return rest.hi <= off * off;
}

NearSet::NearSet(std::vector<Triangle3> triangles) : triangles_(std::move(triangles)) {
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(triangles_.size());
  for (const Triangle3& t : triangles_) boxes.push_back(detail::Box<3>::of(t));
  tree_ = std::make_unique<detail::BoxTree<3>>(boxes, detail::TreeCut::at_medians);
}

NearSet::NearSet(const std::vector<Segment3>& segments)
    : NearSet([&] {
        std::vector<Triangle3> triangles;
        triangles.reserve(segments.size());
        for (const Segment3& s : segments) triangles.push_back({s[0], s[1], s[1]});
        return triangles;
      }()) {}

double NearSet::distance(const Point3& x, double most) const {
  double least = most * most;
  bool found = false;
  tree_->nearest([&](const detail::Box<3>& box, std::uint32_t) { return box.squared_distance_to(x); },
                 [&](std::uint32_t i) {
                   const double square = squared_distance_above(x, triangles_[i]);
                   if (square <= least) {
                     least = square;
                     found = true;
                   }
                   return least;
                 });
  return found ? std::sqrt(least) : infinite;
}

/// One question to a NearSet.
template <std::size_t N>
class NearSet::Decision {
 public:
  using Piece = std::array<Point3, N>;
  Decision(const NearSet& set, double limit) : set_(set), asked_(limit), limit_(limit) {}

  std::optional<FarPlace> run(const Piece& whole) {
    if (set_.empty()) return FarPlace{centroid(whole), infinite, true};
    if (const auto known = look(whole)) return *known ? std::nullopt : std::optional(far_);
    pieces_.clear();
    if constexpr (N == 3)
      cut(whole);
    else
      halve(whole);
    for (std::size_t looked_at = 0; !pieces_.empty(); ++looked_at) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      if (const auto known = look(piece)) {
        if (*known) continue;
        return far_;
      }
      const Point3 c = centroid(piece);
      if (!(radius(piece, c) >= limit_ / least_part) || looked_at == most_pieces)
        return FarPlace{c, set_.distance(c, infinite), false};
      halve(piece);
    }
    return std::nullopt;
  }

 private:
  /// At a thousandth of the distance a piece whose centre is 0.999 of it away has been decided.
  static constexpr double least_part = 1000;
  /// A triangle a thousand times as long as the distance, with pieces of a hundredth of it along all of its border, has 300,000.
  static constexpr std::size_t most_pieces = 4000000;

  static double radius(const Piece& piece, const Point3& c) {
    double square = 0;
    for (const Point3& p : piece) square = std::max(square, squared_distance(p, c));
    return std::sqrt(square);
  }

  /// True: all of it is near; false: its centre is not, which `far_` says; none: not known.
  std::optional<bool> look(const Piece& piece) {
    const Point3 c = centroid(piece);
    double least = 2 * limit_ * limit_;  // beyond it nothing is asked for
    std::uint32_t nearest = none_;
    set_.tree_->nearest([&](const detail::Box<3>& box, std::uint32_t) { return box.squared_distance_to(c); },
                        [&](std::uint32_t i) {
                          const double square = squared_distance_above(c, set_.triangles_[i]);
                          if (square < least || (square == least && i < nearest)) {
                            least = square;
                            nearest = i;
                          }
                          return least;
                        });
    if (nearest == none_ || !is_within(c, set_.triangles_[nearest], limit_)) {
      const double distance = set_.distance(c, infinite);
      far_ = {c, distance, distance > asked_};
      return false;
    }
    const double rest = limit_ - std::sqrt(least) - rounding_of(c, set_.triangles_[nearest]);
    if (radius(piece, c) <= rest * (1 - 0x1p-40)) return true;
    if (has_all(nearest, piece)) return true;
    return std::nullopt;
  }

  bool has_all(std::uint32_t i, const Piece& piece) const {
    return std::ranges::all_of(piece, [&](const Point3& p) { return is_within(p, set_.triangles_[i], limit_); });
  }

  void halve(const Piece& piece) {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < (N == 2 ? 1 : N); ++k)
      if (squared_distance(piece[k], piece[(k + 1) % N]) > squared_distance(piece[longest], piece[(longest + 1) % N]))
        longest = k;
    const Point3 m = middle(piece[longest], piece[(longest + 1) % N]);
    Piece first = piece, second = piece;
    first[(longest + 1) % N] = m;
    second[longest] = m;
    pieces_.push_back(second);
    pieces_.push_back(first);
  }

  /// What of the triangle has no other one above or below it within the distance. What is computed in its plane is off by some
  /// ulps of its size, which the distance is made less by: by less than a fourth, or it is left to halving.
  void cut(const Piece& whole) requires(N == 3) {
    const PlaneFrame frame(whole);
    std::vector<std::uint32_t> near;
    double extent = radius(whole, whole[0]);
    set_.tree_->meeting(detail::Box<3>::of(whole).widened(limit_), [&](std::uint32_t i) {
      near.push_back(i);
      for (const Point3& p : set_.triangles_[i]) extent = std::max(extent, std::sqrt(squared_distance(p, whole[0])));
    });
    const double slack = 0x1p-49 * extent;
    if (!(frame.width() > 0) || !(slack <= limit_ / 4)) return halve(whole);
    limit_ -= slack;
    FlatPolygon polygon;
    for (const Point3& p : whole) {
      const auto at = frame.place(p);
      polygon.push_back({{at[0], at[1]}});
    }
    std::vector<FlatPolygon> rest{polygon};
    for (const Width& width : widths) rest = uncovered(frame, near, width, rest);
    for (const FlatPolygon& left : rest)
      for (std::size_t k = 2; k < left.size(); ++k)
        pieces_.push_back({frame.in_space(left[0]), frame.in_space(left[k - 1]), frame.in_space(left[k])});
  }

  /// How far beside one of the others, and how far above it, a place counts as near, in parts of the distance. A place beside a
  /// corner may be (1 + sqrt 2) times as far away, and where the other rises by no more than 45 degrees its height there adds as
  /// much at most: so all is nearer than 0.99. First what covers most, and leaves no slivers between others.
  struct Width {
    double beside, above;
  };
  static constexpr std::array<Width, 4> widths{{{1.0 / 16, 0.8}, {1.0 / 256, 0.97}, {0, 1 - 0x1p-8}, {1.0 / 4, 0.15}}};

  std::vector<FlatPolygon> uncovered(const PlaneFrame& frame, const std::vector<std::uint32_t>& near, const Width& width,
                                     const std::vector<FlatPolygon>& polygons) const requires(N == 3) {
    if (polygons.empty()) return {};
    std::vector<CoveringTriangle> covers;
    for (const std::uint32_t i : near) {
      const double level = levelness(frame, set_.triangles_[i]);
      if (level == 0) continue;
      const double beside = level > 0.5 ? width.beside * limit_ : 0;
      const CoveringTriangle cover(frame, set_.triangles_[i], beside, width.above * limit_);
      if (!cover.covers_nothing()) covers.push_back(cover);
    }
    std::vector<FlatPolygon> left;
    constexpr double nothing_is_thin = -1;  // a sliver is a piece like all others
    for (const FlatPolygon& polygon : polygons)
      for (FlatPolygon& part : uncovered_parts(polygon, covers, nothing_is_thin)) left.push_back(std::move(part));
    return left;
  }

  /// The squared cosine between a triangle and the plane; 0 if that is so little, or the triangle so thin as it is seen there,
  /// that heights are not known well from where it is seen.
  static double levelness(const PlaneFrame& frame, const Triangle3& t) {
    const auto a = frame.place(t[0]), b = frame.place(t[1]), c = frame.place(t[2]);
    const Vector3 n = detail::cross(difference(t[1], t[0]), difference(t[2], t[0]));
    const double doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), square = dot(n, n);
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, squared_distance(t[i], t[(i + 1) % 3]));
    return std::abs(doubled) < 0x1p-20 * longest || !(square > 0) ? 0 : doubled * doubled / square;
  }

  static constexpr std::uint32_t none_ = 0xffffffffu;
  const NearSet& set_;
  double asked_, limit_;  ///< as it was, and less what cutting has rounded
  FarPlace far_{};
  std::vector<Piece> pieces_;
};

std::optional<FarPlace> NearSet::farther(const Triangle3& piece, double limit) const {
  return Decision<3>(*this, limit).run(piece);
}

std::optional<FarPlace> NearSet::farther(const Segment3& piece, double limit) const {
  return Decision<2>(*this, limit).run(piece);
}

}  // namespace pgdr::checking
