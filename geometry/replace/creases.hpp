// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "replace/complex.hpp"

namespace pgdr::detail {

/// The creases among edges of two faces of one class: those at which normals differ by more than the feature angle, where both
/// sides are higher than needles, and so do the normals beyond needles. Small ones that hang on nothing kept are left out.
/// @param candidates  all such edges; the complex has the other edges of curves already
std::vector<std::array<std::uint32_t, 2>> find_creases(const SurfaceComplex& surface,
                                                       const std::vector<std::array<std::uint32_t, 2>>& candidates,
                                                       double tolerance, double feature_angle);

}  // namespace pgdr::detail
