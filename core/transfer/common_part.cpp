// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "transfer/common_part.hpp"

#include <algorithm>
#include <cmath>

namespace pgdr::detail {
namespace {

template <std::size_t D>
std::array<double, D> between(const std::array<double, D>& in, double at_in, const std::array<double, D>& out, double at_out) {
  std::array<double, D> x;
  for (std::size_t i = 0; i < D; ++i) x[i] = (in[i] * -at_out + out[i] * at_in) / (at_in - at_out);
  return x;
}

double determinant(const std::array<double, 3>& a, const std::array<double, 3>& b, const std::array<double, 3>& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// A convex polygon, counter-clockwise or clockwise.
class Polygon {
 public:
  using Vector = std::array<double, 2>;
  explicit Polygon(const std::array<Vector, 3>& corners) : size_(3) {
    std::copy(corners.begin(), corners.end(), corners_.begin());
  }

  /// Keeps what is on the inner side. @returns whether anything is
  template <class At>
  bool cut(const At& at) {
    std::array<double, most> sides;  // as all here, not set beyond size_: to clear what is not used takes as long as a cut
    for (std::size_t i = 0; i < size_; ++i) sides[i] = at(corners_[i]);
    std::array<Vector, most> out;
    std::size_t n = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::size_t k = (i + 1) % size_;
      if (sides[i] >= 0) out[n++] = corners_[i];
      if ((sides[i] >= 0) != (sides[k] >= 0))
        out[n++] = sides[i] >= 0 ? between(corners_[i], sides[i], corners_[k], sides[k])
                                 : between(corners_[k], sides[k], corners_[i], sides[i]);
    }
    std::copy_n(out.begin(), n, corners_.begin());
    size_ = n;
    return n > 0;
  }

  double measure() const {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < size_; ++i) {
      const auto &a = corners_[0], &b = corners_[i], &c = corners_[i + 1];
      twice += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }
    return std::abs(twice) / 2;
  }

 private:
  static constexpr std::size_t most = 16;  // three corners; each cut adds one, or with rounding two
  std::array<Vector, most> corners_;
  std::size_t size_;
};

/// A convex polyhedron as the graph of its edges: each vertex has three neighbours, in the order in which they are seen from
/// outside. A cut puts a vertex on each edge that it crosses, and links these along the faces that it crosses.
class Polyhedron {
 public:
  using Vector = std::array<double, 3>;
  explicit Polyhedron(const std::array<Vector, 4>& corners) : size_(4) {
    constexpr std::array<std::array<int, 3>, 4> beside{{{1, 3, 2}, {2, 3, 0}, {0, 3, 1}, {1, 2, 0}}};
    for (std::size_t i = 0; i < 4; ++i) vertices_[i] = {corners[i], beside[i]};
  }

  /// Keeps what is on the inner side. @returns whether anything is
  template <class At>
  bool cut(const At& at) {
    std::array<double, most> sides;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      sides[i] = at(vertices_[i].place);
      outside += sides[i] < 0;
    }
    if (outside == 0 || outside == size_) return outside == 0;
    const std::size_t old = size_;
    for (std::size_t v = 0; v < old; ++v) {
      if (sides[v] < 0) continue;
      for (int& beside : vertices_[v].beside) {
        const auto w = static_cast<std::size_t>(beside);
        if (w >= old || !(sides[w] < 0)) continue;
        vertices_[size_] = {between(vertices_[v].place, sides[v], vertices_[w].place, sides[w]), {static_cast<int>(v), -1, -1}};
        beside = static_cast<int>(size_++);
      }
    }
    for (std::size_t v = old; v < size_; ++v)
      if (!link(v, old)) return false;
    drop(sides, old);
    return true;
  }

  double measure() const {
    double sixfold = 0;
    std::array<std::array<bool, 3>, most> done;
    std::fill_n(done.begin(), size_, std::array<bool, 3>{});
    for (std::size_t v = 0; v < size_; ++v)
      for (int k = 0; k < 3; ++k)
        if (!done[v][static_cast<std::size_t>(k)]) sixfold += face_at(v, k, done);
    return std::abs(sixfold) / 6;
  }

 private:
  struct Vertex {
    Vector place;
    std::array<int, 3> beside;
  };
  /// Of a convex polyhedron of eight faces there are 12 vertices. Whatever rounding says of sides, a cut no more than doubles
  /// them: 64 after four, and 80 during the last.
  static constexpr std::size_t most = 80;

  const Vector& place(int v) const { return vertices_[static_cast<std::size_t>(v)].place; }
  int beside(int v, int k) const { return vertices_[static_cast<std::size_t>(v)].beside[static_cast<std::size_t>(k)]; }
  /// Along a face: the number of the edge at w that follows the one from v.
  int next_edge(int v, int w) const {
    int k = 0;
    while (k < 2 && beside(w, k) != v) ++k;
    return (k + 1) % 3;
  }

  /// From a new vertex along a face to the next new one. @returns false if there is none, as where rounding has made a part so
  /// thin that it is no polyhedron any more: it counts as nothing
  bool link(std::size_t first, std::size_t old) {
    int v = static_cast<int>(first), w = beside(v, 0);
    for (std::size_t steps = 0; steps < 2 * most; ++steps) {
      const int k = next_edge(v, w);
      v = w;
      w = beside(v, k);
      if (static_cast<std::size_t>(v) < old) continue;
      vertices_[first].beside[2] = v;
      vertices_[static_cast<std::size_t>(v)].beside[1] = static_cast<int>(first);
      return true;
    }
    return false;
  }

  void drop(const std::array<double, most>& sides, std::size_t old) {
    std::array<int, most> number;
    std::size_t n = 0;
    for (std::size_t v = 0; v < size_; ++v) {
      if (v < old && sides[v] < 0) continue;
      number[v] = static_cast<int>(n);
      vertices_[n++] = vertices_[v];
    }
    size_ = n;
    for (std::size_t v = 0; v < size_; ++v)
      for (int& w : vertices_[v].beside) w = number[static_cast<std::size_t>(w)];
  }

  /// Six times the volume between a face and the origin.
  double face_at(std::size_t first, int k, std::array<std::array<bool, 3>, most>& done) const {
    double sixfold = 0;
    const int start = static_cast<int>(first);
    int v = start, w = beside(v, k);
    done[first][static_cast<std::size_t>(k)] = true;
    for (std::size_t steps = 0; w != start && steps < 2 * most; ++steps) {
      k = next_edge(v, w);
      const int from = v;
      v = w;
      w = beside(v, k);
      done[static_cast<std::size_t>(v)][static_cast<std::size_t>(k)] = true;
      if (from != start) sixfold += determinant(place(start), place(from), place(v));
    }
    return sixfold;
  }

  std::array<Vertex, most> vertices_;
  std::size_t size_;
};

}  // namespace

template <int D>
InsideOf<D>::InsideOf(const Simplex<D>& simplex) : origin_(simplex[0]) {
  std::array<Vector, D + 1> x;
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
double InsideOf<D>::common_with(const Simplex<D>& other) const {
  std::array<Vector, D + 1> x;
  for (std::size_t i = 0; i <= D; ++i) x[i] = relative(other[i]);
  std::array<bool, D + 1> cuts;
  for (std::size_t k = 0; k <= D; ++k) {
    std::size_t inside = 0, outside = 0;
    for (const Vector& p : x) {
      const double side = planes_[k].at(p);
      inside += side >= 0;
      outside += side <= 0;
    }
    if (outside == D + 1) return 0;
    cuts[k] = inside <= D;
  }
  std::conditional_t<D == 2, Polygon, Polyhedron> part(x);
  for (std::size_t k = 0; k <= D; ++k)
    if (cuts[k] && !part.cut([&plane = planes_[k]](const Vector& p) { return plane.at(p); })) return 0;
  return part.measure();
}

template class InsideOf<2>;
template class InsideOf<3>;

}  // namespace pgdr::detail
