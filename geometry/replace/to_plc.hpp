// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pgdr/plc.hpp"
#include "replace/complex.hpp"

namespace pgdr::detail {

/// The facets, segments and points of a surface, in an order of their coordinates.
struct SurfacePlc {
  Plc<3> plc;                                  ///< without seeds, names, markers and attributes of points
  std::vector<std::uint32_t> vertex_of_point;  ///< of each point of plc, its number in the complex
  std::vector<std::uint32_t> face_of_facet;    ///< of each facet of plc, one of its faces in the complex
};
SurfacePlc to_plc(const SurfaceComplex& surface, const LoosePieces& loose);

}  // namespace pgdr::detail
