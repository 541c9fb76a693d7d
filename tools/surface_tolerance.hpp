// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The words of --surface-tolerance as a length, one reading for all commands.
#pragma once

#include <optional>
#include <string>

#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// E, or E%.
struct SurfaceToleranceText {
  double number;    ///< as it stands, finite, or infinite where it is too large for a double
  bool is_percent;  ///< of the diagonal of all points
};
/// None if the text is no number, nor one with a % behind it.
std::optional<SurfaceToleranceText> split_surface_tolerance(const std::string& text);

/// The length E that the text says, in the units of the input, whose default tolerance or own one, or else `tolerance`, is T,
/// at least the rounding of doubles.
/// @throws UsageError bad_option if it is no length above 0 or less than 16 T, or if the input has no extent that a percentage
///   could be of; both lengths are said
double surface_tolerance(const std::string& text, const Plc<3>& plc, std::optional<double> tolerance = {});

/// @throws InputError tolerance_too_large if that is over 2 % of the diagonal of all points, and Plc::is_coarse is not set
void require_fine_surface_tolerance(double length, const Plc<3>& plc);

}  // namespace pgdr::tool
