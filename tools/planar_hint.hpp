// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether a refused input would be taken with --resolve-crossings, or in 2D with --convex-hull. Prints nothing.
#pragma once

#include <optional>
#include <string>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// The flags that make the input valid, and what they do, as one sentence; none if the diagnosis has found nothing that they are
/// for, or they do not make it valid.
template <int D>
std::optional<std::string> flags_for_refused(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

}  // namespace pgdr::tool
