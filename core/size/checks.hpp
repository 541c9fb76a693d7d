// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the makers of sizing fields demand, and the length that a size stands for.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "input/words.hpp"
#include "pgdr/error.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

/// The length that grows: the circumradius bound itself in 3D, the root of the area bound in 2D.
template <int D>
double length_of(double size) {
  return D == 2 ? std::sqrt(size) : size;
}
template <int D>
double size_of_length(double length) {
  return D == 2 ? length * length : length;
}

inline void require_growth(double growth) {
  if (!(growth >= 0) || !std::isfinite(growth))
    throw UsageError({Errc::bad_option, "the growth of sizes must be finite and not negative", {}, 0, {}, {}});
}

/// One size of the `what` each, all positive and finite.
inline void require_positive(std::span<const double> sizes, const std::string& what) {
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] > 0 && std::isfinite(sizes[i])) continue;
    throw UsageError({.code = Errc::bad_size,
                      .message = "the size at " + what + " " + std::to_string(i) + " is " + to_text(sizes[i]) +
                                 "; sizes must be positive and finite",
                      .ids = {static_cast<std::int64_t>(i)}});
  }
}

/// One positive, finite size a point, and finite points.
template <int D>
void require_sizes(std::span<const Point<D>> points, std::span<const double> sizes) {
  if (points.size() != sizes.size())
    throw UsageError({Errc::bad_option,
                      std::to_string(sizes.size()) + " sizes for " + std::to_string(points.size()) + " points",
                      {},
                      0,
                      {},
                      {}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    Diagnostic d{Errc::bad_size, {}, {}, 0, {static_cast<std::int64_t>(i)}, {}};
    d.points.push_back({points[i][0], points[i][1], D == 3 ? points[i][D - 1] : 0.0});
    for (int j = 0; j < D; ++j)
      if (!std::isfinite(points[i][j])) {
        d.code = Errc::not_finite;
        d.message = "point " + std::to_string(i) + " of the sizing field is not finite";
        throw InputError(std::move(d));
      }
    if (sizes[i] > 0 && std::isfinite(sizes[i])) continue;
    d.message = "the size at point " + std::to_string(i) + " is " + to_text(sizes[i]) + "; sizes must be positive and finite";
    throw UsageError(std::move(d));
  }
}

template <int D>
void require_indices(const OutputMesh<D>& mesh) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const std::uint32_t v : mesh.cells[c])
      if (v >= mesh.points.size())
        throw InputError(
            {Errc::index_out_of_range,
             "cell " + std::to_string(c) + " has vertex " + std::to_string(v) + " of " + std::to_string(mesh.points.size()),
             {},
             0,
             {static_cast<std::int64_t>(c)},
             {}});
}

}  // namespace pgdr::detail
