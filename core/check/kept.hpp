// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether the boundary was kept as it was given (RefineOptions::keep_boundary).
#pragma once

#include "given/match.hpp"
#include "pgdr/check.hpp"

namespace pgdr::checking {

/// Of what was to be kept: no subfacet (2D: subsegment) has a vertex that is no given point and no place where given edges cross;
/// and each given triangle (2D: segment) is one, but where another such vertex lies on it, part of it is not in the mesh, or it
/// is not ten times as high as what joins things. A polygon of more than three corners may be triangulated in any way.
template <int D>
void check_kept(const GivenTask<D>& task, const GivenMatch<D>& match, const CheckOptions<D>& options);

}  // namespace pgdr::checking
