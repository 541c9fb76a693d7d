// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large elements may be: the circumradius bound in 3D, the area bound in 2D, at the centroid. A constant, or a function
// of position; made of others, of points, or of a background mesh in size_fields.hpp. A constant costs no call, a function
// one a cell that is made, so that a slow one (above some 100 ns) is what a refinement waits for. Where a call is dear and a
// point is cheap, as in an interpreter, a function by blocks is asked for many points at once. Single regions may have
// sizes of their own (RegionSizes), and bounds of volume (area) by their seeds (RegionSeed::size). Where several bounds apply,
// all are met.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// A function of position is called concurrently from any worker: it must be deterministic and thread-safe, may throw.
template <int D>
using SizeFunction = std::function<double(const Point<D>&)>;

/// A function of position for many points at once: puts the size at points[i] into sizes[i], for all i, and keeps neither span.
/// Each must be a function of its point alone, whatever block the point is in. It is called concurrently from any worker, with
/// one point or more, as many as have to be known at that time: it must be deterministic and thread-safe, may throw. What it
/// leaves unset is NaN, an error.
template <int D>
using SizeBlock = std::function<void(std::span<const Point<D>> points, std::span<double> sizes)>;

/// A bound everywhere. A value; copies of a function share what it points to.
template <int D>
class SizingField {
 public:
  SizingField() = default;  ///< no bound
  /// The same everywhere, in units of the input (3D) or their squares (2D).
  SizingField(double constant) : constant_(constant) {}  // NOLINT: implicit by design
  /// f(x), for any point x of the domain; see SizeFunction.
  template <class F>
  requires std::is_invocable_r_v < double, F, const Point<D>
  & > SizingField(F f) : function_(std::move(f)) {}  // NOLINT
  /// A function that is asked by blocks; no bound if it is empty. It makes the mesh that the same function makes point by point.
  static SizingField by_blocks(SizeBlock<D> block) {
    SizingField field;
    if (!block) return field;
    field.block_ = std::make_shared<const SizeBlock<D>>(std::move(block));
    field.function_ = [block = field.block_](const Point<D>& x) {
      double size = std::numeric_limits<double>::quiet_NaN();
      (*block)({&x, 1}, {&size, 1});
      return size;
    };
    return field;
  }
  /// Can any cell be too large?
  bool bounded() const { return function_ || constant_ != std::numeric_limits<double>::infinity(); }
  /// No function; at() is the same everywhere.
  bool is_constant() const { return !function_; }
  /// Is it to be asked for many points at once?
  bool is_by_blocks() const { return block_ != nullptr; }
  /// The bound at x. Not validated here: the caller turns a value that is not positive into Errc::bad_size.
  double at(const Point<D>& x) const { return function_ ? function_(x) : constant_; }
  /// The bounds at the points, as one block. @pre as many sizes
  void at(std::span<const Point<D>> points, std::span<double> sizes) const {
    if (!block_) {
      std::transform(points.begin(), points.end(), sizes.begin(), [this](const Point<D>& x) { return at(x); });
    } else if (!points.empty()) {
      std::fill(sizes.begin(), sizes.end(), std::numeric_limits<double>::quiet_NaN());
      (*block_)(points, sizes);
    }
  }

 private:
  double constant_ = std::numeric_limits<double>::infinity();
  SizeFunction<D> function_;                   ///< empty: a constant
  std::shared_ptr<const SizeBlock<D>> block_;  ///< null: asked point by point
};

/// The sizes of one region.
template <int D>
struct RegionSize {
  double label = 0;     ///< of its cells: the attribute of its seed, its number (numbers_volumes), 0 without either
  SizingField<D> size;  ///< as RefineOptions::size, asked at the centroids of the region's cells alone
};

/// Sizes by region. Those of several entries with one label are all met.
template <int D>
using RegionSizes = std::vector<RegionSize<D>>;

}  // namespace pgdr
