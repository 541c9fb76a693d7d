// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large elements may be: the circumradius bound in 3D, the area bound in 2D, at the centroid; and a measure
// (volume in 3D, area in 2D) bound, constant and per region. A constant costs no call.
#pragma once

#include <functional>
#include <limits>
#include <variant>

#include "pgdr/types.hpp"

namespace pgdr {

/// A function of position is called concurrently from any worker: it must be deterministic and thread-safe, may throw.
template <int D>
using SizeFunction = std::function<double(const Point<D>&)>;

template <int D>
class SizingField {
 public:
  SizingField() = default;                              ///< no bound
  SizingField(double constant) : constant_(constant) {} // NOLINT: implicit by design
  template <class F>
    requires std::is_invocable_r_v<double, F, const Point<D>&>
  SizingField(F f) : function_(std::move(f)) {}         // NOLINT
  bool bounded() const { return function_ || constant_ != std::numeric_limits<double>::infinity(); }
  bool is_constant() const { return !function_; }
  /// The bound at x. Not validated here: the caller turns a value that is not positive into Errc::bad_size.
  double at(const Point<D>& x) const { return function_ ? function_(x) : constant_; }

 private:
  double constant_ = std::numeric_limits<double>::infinity();
  SizeFunction<D> function_;
};

}  // namespace pgdr
