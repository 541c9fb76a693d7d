// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "transfer/common_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace pgdr::detail {
namespace {

/// Where the edge between a point inside of a plane and one outside crosses it.
template <std::size_t D>
std::array<double, D> between(const std::array<double, D>& in, double at_in, const std::array<double, D>& out, double at_out) {
  const double share = at_in / (at_in - at_out);
  std::array<double, D> x;
  for (std::size_t i = 0; i < D; ++i) x[i] = in[i] + share * (out[i] - in[i]);
  return x;
}

double determinant(const std::array<double, 3>& a, const std::array<double, 3>& b, const std::array<double, 3>& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// A convex polygon, counter-clockwise or clockwise. Sides have numbers: those of the triangle that it was, then those of cuts.
class Polygon {
 public:
  using Vector = std::array<double, 2>;
  /// Side k is opposite corner k.
  explicit Polygon(const std::array<Vector, 3>& corners) : size_(3) {
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = {corners[i], static_cast<std::uint8_t>((i + 2) % 3)};
  }

  /// Keeps what is on the inner side; the cut is this side. @returns whether anything is
  /// @param of_corners  where nothing is cut yet: at() of the corners
  template <class At>
  bool cut(std::uint8_t side, const At& at, const std::array<double, 3>* of_corners) {
    std::array<double, most> sides;  // as all here, not set beyond size_: to clear what is not used takes as long as a cut
    for (std::size_t i = 0; i < size_; ++i) sides[i] = of_corners ? (*of_corners)[i] : at(corners_[i].place);
    std::array<Corner, most> out;
    std::size_t n = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::size_t k = (i + 1) % size_;
      const Corner &a = corners_[i], &b = corners_[k];
      if (sides[i] >= 0) out[n++] = a;
      if ((sides[i] >= 0) == (sides[k] >= 0)) continue;
      out[n++] = sides[i] >= 0 ? Corner{between(a.place, sides[i], b.place, sides[k]), side}
                               : Corner{between(b.place, sides[k], a.place, sides[i]), a.side};
    }
    std::copy_n(out.begin(), n, corners_.begin());
    size_ = n;
    return n > 0;
  }

  /// Which sides it has, as bits.
  unsigned sides() const {
    unsigned bits = 0;
    for (std::size_t i = 0; i < size_; ++i) bits |= 1u << corners_[i].side;
    return bits;
  }

  /// Points on the sides are not needed.
  template <class Places>
  double measure(const Places&) const {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < size_; ++i) {
      const auto &a = corners_[0].place, &b = corners_[i].place, &c = corners_[i + 1].place;
      twice += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }
    return std::abs(twice) / 2;
  }

 private:
  struct Corner {
    Vector place;
    std::uint8_t side;  ///< to the next corner
  };
  static constexpr std::size_t most = 16;  // three corners; each cut adds one, or with rounding two
  std::array<Corner, most> corners_;
  std::size_t size_;
};

/// A convex polyhedron as the graph of its edges: each vertex has three neighbours, in the order in which they are seen from
/// outside, and three sides, of which side k is between edge k and the next. A cut puts a vertex on each edge that it crosses,
/// and links these along the sides that it crosses. Sides have numbers: those of the tetrahedron that it was, then those of cuts.
class Polyhedron {
 public:
  using Vector = std::array<double, 3>;
  /// Side k is opposite corner k.
  explicit Polyhedron(const std::array<Vector, 4>& corners) : size_(4) {
    constexpr std::array<std::array<std::uint8_t, 3>, 4> beside{{{1, 3, 2}, {2, 3, 0}, {0, 3, 1}, {1, 2, 0}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& b = beside[i];
      vertices_[i] = {corners[i], b, {b[2], b[0], b[1]}};
    }
  }

  /// Keeps what is on the inner side; the cut is this side. @returns whether anything is
  /// @param of_corners  where nothing is cut yet: at() of the corners
  template <class At>
  bool cut(std::uint8_t side, const At& at, const std::array<double, 4>* of_corners) {
    std::array<double, most> sides;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      sides[i] = of_corners ? (*of_corners)[i] : at(vertices_[i].place);
      outside += sides[i] < 0;
    }
    if (outside == 0 || outside == size_) return outside == 0;
    const std::size_t old = size_;
    for (std::size_t v = 0; v < old; ++v) {
      if (sides[v] < 0) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t w = vertices_[v].beside[k];
        if (w >= old || !(sides[w] < 0)) continue;
        vertices_[size_] = {between(vertices_[v].place, sides[v], vertices_[w].place, sides[w]),
                            {static_cast<std::uint8_t>(v), nobody, nobody},
                            {vertices_[v].sides[k == 0 ? 2 : k - 1], side, vertices_[v].sides[k]}};
        vertices_[v].beside[k] = static_cast<std::uint8_t>(size_++);
      }
    }
    if (!link_by_sides(old))
      for (std::size_t v = old; v < size_; ++v)
        if (!link(v, old)) return false;
    drop(sides, old);
    return true;
  }

  /// Which sides it has, as bits.
  unsigned sides() const {
    unsigned bits = 0;
    for (std::size_t v = 0; v < size_; ++v)
      for (const std::uint8_t side : vertices_[v].sides) bits |= 1u << side;
    return bits;
  }

  /// The sum over all sides of their areas times their distances from the origin: each edge ab counts a x b for the side to its
  /// left, and as much less for that to its right.
  /// @param on_side  of each side any point of its plane
  template <class Places>
  double measure(const Places& on_side) const {
    double sixfold = 0;
    for (std::size_t v = 0; v < size_; ++v) {
      const Vertex& a = vertices_[v];
      for (std::size_t k = 0; k < 3; ++k) {
        if (a.beside[k] <= v) continue;
        const Vector &b = vertices_[a.beside[k]].place, &left = on_side[a.sides[k]],
                     &right = on_side[a.sides[k == 0 ? 2 : k - 1]];
        sixfold += (a.place[1] * b[2] - a.place[2] * b[1]) * (left[0] - right[0]) +
                   (a.place[2] * b[0] - a.place[0] * b[2]) * (left[1] - right[1]) +
                   (a.place[0] * b[1] - a.place[1] * b[0]) * (left[2] - right[2]);
      }
    }
    return std::abs(sixfold) / 6;
  }

 private:
  static constexpr std::uint8_t nobody = 255;
  struct Vertex {
    Vector place;
    std::array<std::uint8_t, 3> beside, sides;
  };
  /// Of a convex polyhedron of eight faces there are 12 vertices. Whatever rounding says of sides, a cut no more than doubles
  /// them: 64 after four, and 80 during the last.
  static constexpr std::size_t most = 80;
  static constexpr std::size_t most_sides = 8;

  /// Two new vertices on each side that is crossed. @returns false, and leaves what is to be found by walks, where a side is
  /// crossed more than once, as by rounding where it lies in the plane of the cut
  bool link_by_sides(std::size_t old) {
    std::array<std::uint8_t, most_sides> to;
    to.fill(nobody);
    for (std::size_t v = old; v < size_; ++v) {
      std::uint8_t& there = to[vertices_[v].sides[0]];
      if (there != nobody) return false;
      there = static_cast<std::uint8_t>(v);
    }
    for (std::size_t v = old; v < size_; ++v) {
      std::uint8_t& there = to[vertices_[v].sides[2]];
      if (there == nobody) return false;
      vertices_[v].beside[2] = there;
      vertices_[there].beside[1] = static_cast<std::uint8_t>(v);
      there = nobody;
    }
    return true;
  }

  /// Along a side: the number of the edge at w that follows the one from v.
  std::size_t next_edge(std::size_t v, std::size_t w) const {
    std::size_t k = 0;
    while (k < 2 && vertices_[w].beside[k] != v) ++k;
    return (k + 1) % 3;
  }

  /// From a new vertex along a side to the next new one. @returns false if there is none, as where rounding has made a part so
  /// thin that it is no polyhedron any more: it counts as nothing
  bool link(std::size_t first, std::size_t old) {
    std::size_t v = first, w = vertices_[first].beside[0];
    for (std::size_t steps = 0; steps < 2 * most; ++steps) {
      const std::size_t k = next_edge(v, w);
      v = w;
      w = vertices_[w].beside[k];
      if (v < old) continue;
      vertices_[first].beside[2] = static_cast<std::uint8_t>(v);
      vertices_[v].beside[1] = static_cast<std::uint8_t>(first);
      return true;
    }
    return false;
  }

  void drop(const std::array<double, most>& sides, std::size_t old) {
    std::array<std::uint8_t, most> number;
    std::size_t n = 0;
    for (std::size_t v = 0; v < size_; ++v) {
      if (v < old && sides[v] < 0) continue;
      number[v] = static_cast<std::uint8_t>(n);
      if (n != v) vertices_[n] = vertices_[v];
      ++n;
    }
    size_ = n;
    for (std::size_t v = 0; v < size_; ++v)
      for (std::uint8_t& w : vertices_[v].beside) w = number[w];
  }

  std::array<Vertex, most> vertices_;
  std::size_t size_;
};

}  // namespace

template <int D>
InsideOf<D>::InsideOf(const Simplex<D>& simplex) : origin_(simplex[0]) {
  std::array<Vector, D + 1>& x = corners_;
  for (std::size_t i = 0; i <= D; ++i) x[i] = relative(simplex[i]);
  for (std::size_t k = 0; k <= D; ++k) {
    const Vector& base = x[(k + 1) % (D + 1)];
    Vector& n = planes_[k].normal;
    if constexpr (D == 2) {
      const Vector& other = x[(k + 2) % 3];
      n = {base[1] - other[1], other[0] - base[0]};
    } else {
      Vector u, v;
      for (std::size_t i = 0; i < 3; ++i) {
        u[i] = x[(k + 2) % 4][i] - base[i];
        v[i] = x[(k + 3) % 4][i] - base[i];
      }
      n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    }
    planes_[k].offset = 0;
    planes_[k].offset = -planes_[k].at(base);
    if (planes_[k].at(x[k]) < 0) {
      for (double& c : n) c = -c;
      planes_[k].offset = -planes_[k].offset;
    }
  }
  if constexpr (D == 2)
    measure_ = std::abs(x[1][0] * x[2][1] - x[1][1] * x[2][0]) / 2;
  else
    measure_ = std::abs(determinant(x[1], x[2], x[3])) / 6;
}

template <int D>
double InsideOf<D>::common_with(const Simplex<D>& other, unsigned& sides) const {
  std::array<Vector, D + 1> x;
  for (std::size_t i = 0; i <= D; ++i) x[i] = relative(other[i]);
  std::array<std::array<double, D + 1>, D + 1> at;  // of planes, of corners
  std::array<bool, D + 1> cuts;
  for (std::size_t k = 0; k <= D; ++k) {
    std::size_t inside = 0, outside = 0;
    for (std::size_t i = 0; i <= D; ++i) {
      at[k][i] = planes_[k].at(x[i]);
      inside += at[k][i] >= 0;
      outside += at[k][i] <= 0;
    }
    if (outside == D + 1) return 0;
    cuts[k] = inside <= D;
  }
  std::conditional_t<D == 2, Polygon, Polyhedron> part(x);
  bool is_whole = true;
  for (std::size_t k = 0; k <= D; ++k) {
    if (!cuts[k]) continue;
    const auto of_plane = [&plane = planes_[k]](const Vector& p) { return plane.at(p); };
    if (!part.cut(static_cast<std::uint8_t>(D + 1 + k), of_plane, is_whole ? &at[k] : nullptr)) return 0;
    is_whole = false;
  }
  std::array<Vector, 2 * (D + 1)> on_side;
  for (std::size_t k = 0; k <= D; ++k) {
    on_side[k] = x[(k + 1) % (D + 1)];
    on_side[D + 1 + k] = corners_[(k + 1) % (D + 1)];
  }
  sides = part.sides() & ((1u << (D + 1)) - 1);
  return part.measure(on_side);
}

template class InsideOf<2>;
template class InsideOf<3>;

}  // namespace pgdr::detail
