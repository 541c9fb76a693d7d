// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How exact the coordinates of a file can be, by the digits that they have. Programs print six, or store floats; a planar face
// that is slanted, and made of triangles, is then planar up to these digits only. Pure function; any thread.
#pragma once

#include <span>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// A Plc::precision with which faces are planar that were so before their coordinates were rounded: 10^(1 - n) for coordinates
/// of at most n significant digits, n from 5 to 7 (no coordinate is off by more than half of that times its size); 2^-22 for
/// numbers of 8 or 9 digits, and for floats; else 2^-48, for rounding alone: coordinates of up to four digits count as exact.
double written_precision(std::span<const Point3> points);

}  // namespace pgdr
