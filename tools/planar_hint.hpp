// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a refused input in 2D would be taken with --resolve-crossings or --convex-hull. Prints nothing.
#pragma once

#include <optional>
#include <string>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// The flags that make the input valid, and what they do, as one sentence; none if the diagnosis has found nothing that they are
/// for, or they do not make it valid. 3D: none.
template <int D>
std::optional<std::string> flags_for_refused(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

}  // namespace pgdr::tool
