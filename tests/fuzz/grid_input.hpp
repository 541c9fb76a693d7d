// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bytes as an input whose points are on the grid {0..2}^3 or {0..3}^2. The first byte are flags: 1 a box (2D: a square)
// round it all, 2 turned obliquely, 4 automatic regions. Then, until the bytes end or most_items: a byte that says what
// (modulo 6), and a byte for each of its points (their number on the grid, modulo its size): 0, 1 a triangle (2D: a
// segment), 2 a segment, 3 a point, 4 a quadrilateral (2D: a path of three segments), 5 a seed of a region, or of a hole
// if the first byte of the item is 128 or more; seeds are a quarter step off the grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pgdr/plc.hpp"
#include "repair_plcs.hpp"

namespace pgdr::fuzz {

template <int D>
struct GridInput {
  Plc<D> plc;
  bool automatic = false;
};

constexpr std::size_t most_items = 10;

template <int D>
class GridReader {
 public:
  explicit GridReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  GridInput<D> read() {
    const std::uint8_t flags = next();
    if (flags & 1) box();
    for (std::size_t k = 0; k < most_items && !bytes_.empty(); ++k) item(next());
    return {flags & 2 ? test::oblique(plc_) : plc_, (flags & 4) != 0};
  }

 private:
  static constexpr std::uint32_t steps = D == 3 ? 3 : 4;

  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  Point<D> place() {
    std::uint32_t n = next();
    Point<D> p;
    for (int i = 0; i < D; ++i, n /= steps) p[i] = n % steps;
    return p;
  }
  /// A point a use: duplicates are merged.
  std::uint32_t point(const Point<D>& p) {
    plc_.points.push_back(p);
    return static_cast<std::uint32_t>(plc_.points.size() - 1);
  }
  void segment(const Point<D>& a, const Point<D>& b) { plc_.segments.push_back({{point(a), point(b)}, 7}); }
  void polygon(const std::vector<Point<D>>& corners) {
    std::vector<std::uint32_t> ids;
    for (const auto& p : corners) ids.push_back(point(p));
    plc_.facets.push_back({{ids}, {}, static_cast<int>(plc_.facets.size() % 2)});
  }

  void item(std::uint8_t what) {
    std::vector<Point<D>> corners(what % 6 == 4 ? 4 : D == 3 && what % 6 < 2 ? 3 : what % 6 < 3 ? 2 : 1);
    for (auto& p : corners) p = place();
    if (what % 6 == 5) return seed(corners[0], what);
    if (corners.size() == 1) return void(point(corners[0]));
    if constexpr (D == 3) {
      if (corners.size() > 2) return polygon(corners);
    }
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) segment(corners[k], corners[k + 1]);
  }
  void seed(Point<D> p, std::uint8_t what) {
    for (int i = 0; i < D; ++i) p[i] += 0.25;
    if (what >= 128)
      plc_.holes.push_back(p);
    else
      plc_.regions.push_back({p, static_cast<double>(what), 0});
  }

  void box() {
    const double far = steps - 1;
    if constexpr (D == 2) {
      const Point<2> corners[] = {{0, 0}, {far, 0}, {far, far}, {0, far}};
      for (std::size_t k = 0; k < 4; ++k) segment(corners[k], corners[(k + 1) % 4]);
    } else {
      for (int axis = 0; axis < 3; ++axis)
        for (const double at : {0.0, far}) {
          std::vector<Point<3>> corners(4);
          for (std::size_t k = 0; k < 4; ++k) {
            corners[k][axis] = at;
            corners[k][(axis + 1) % 3] = k == 1 || k == 2 ? far : 0;
            corners[k][(axis + 2) % 3] = k >= 2 ? far : 0;
          }
          polygon(corners);
        }
    }
  }

  std::span<const std::uint8_t> bytes_;
  Plc<D> plc_;
};

template <int D>
GridInput<D> grid_input(std::span<const std::uint8_t> bytes) {
  return GridReader<D>(bytes).read();
}

}  // namespace pgdr::fuzz
