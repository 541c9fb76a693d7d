// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run asks about the cells that gaps take (pgdr/estimate.hpp): whether there is memory for them.
#pragma once

#include <stop_token>

#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

/// Refuses what gaps ask for more memory for than there is, unless the caller has bounded the run.
/// @throws ResourceError, CancelledError
template <int D>
void guard_memory(const Domain<D>& domain, const RefineOptions<D>& options, const std::stop_token& stop);

}  // namespace pgdr::detail
