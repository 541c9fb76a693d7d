// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a refused input in 2D would be taken with --resolve-crossings or --convex-hull.
#pragma once

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// Prints the flags that make the input valid, if the diagnosis has found what they are for, and they do. 3D: nothing.
template <int D>
void hint_at_flags_of_refused(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

}  // namespace pgdr::tool
