// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles of the input compared with bounds, exactly. Pure functions, any thread.
#pragma once

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// The half-planes from the line ab through c and through d meet at less than the angle with this cosine. False where c or d lies
/// on the line.
bool dihedral_below(const Point3& a, const Point3& b, const Point3& c, const Point3& d, double cosine);

/// The angle at v between the directions to a and b is below arcsin(1 / (2 bound)): too sharp for a triangle with that corner, or
/// with part of it, to have a circumradius within `bound` times its shortest edge. False where a or b is v.
template <int D>
bool is_too_sharp(const Point<D>& v, const Point<D>& a, const Point<D>& b, double bound);

/// The direction from v to r makes an angle below arcsin(1 / (2 bound)) with some direction between those to b and to c, in their
/// plane: `is_too_sharp` of the nearest. False where r is v, or b and c are on a line with it.
bool is_too_near_corner(const Point3& v, const Point3& r, const Point3& b, const Point3& c, double bound);

}  // namespace pgdr::detail
