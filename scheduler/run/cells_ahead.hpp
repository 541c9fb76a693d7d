// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run asks about the cells that gaps take (pgdr/estimate.hpp): whether there is memory for them, and how many they are.
#pragma once

#include <stop_token>

#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"
#include "space/pieces.hpp"

namespace pgdr::detail {

/// Refuses what gaps ask for more memory for than there is, unless the caller has bounded the run.
/// @throws ResourceError, CancelledError
template <int D>
void guard_memory(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop);

/// About how many cells gaps ask for; 0: it was stopped.
template <int D>
double estimate_in_run(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop,
                       const Pieces& pieces);

}  // namespace pgdr::detail
