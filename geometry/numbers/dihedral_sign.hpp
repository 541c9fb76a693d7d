// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Positive where the half-planes from the line ab through c and through d meet at less than 90 degrees, zero at 90.
/// Exact. Zero, too, where c or d lies on the line.
Sign dihedral_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

}  // namespace pgdr::detail
