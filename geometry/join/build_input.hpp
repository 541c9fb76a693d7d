// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What every step of a Domain after its points reads: the input, its distinct points, and how long loops are run.
#pragma once

#include <cstdint>
#include <span>

#include "pgdr/plc.hpp"
#include "space/bulk.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

template <int D>
struct BuildInput {
  const Plc<D>& plc;
  std::span<const Point<D>> points;               ///< distinct
  std::span<const std::uint32_t> point_of_input;  ///< distinct point of each Plc point
  /// A power of two that makes the largest coordinate from one to two: areas and normals are formed of such coordinates, and
  /// neither overflow nor depend on the unit of length.
  double scale;
  double tolerance;  ///< within which things meet, in units of the coordinates
  const Bulk& bulk;
  const StopCheck& stop;
};

}  // namespace pgdr::detail
