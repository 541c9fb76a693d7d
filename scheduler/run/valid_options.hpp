// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which options of a run can be: bounds that are positive, flags that go together.
#pragma once

#include <string>

#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

/// @throws UsageError bad_option, in these words
[[noreturn]] void bad_option(const std::string& what);

/// @throws UsageError bad_option, which says what is wrong
template <int D>
void validate(const RefineOptions<D>& options);

}  // namespace pgdr::detail
