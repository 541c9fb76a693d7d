// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/near_search.hpp"

namespace pgdr::detail {

/// Refuses edges that pass each other as near as the tolerance says where neither has a point. (Where they meet exactly the
/// diagnosis says so.)
void refuse_near_crossings(const BuildInput<3>& in, const NearSearch<3>& near, BuildReport<3>& report);

}  // namespace pgdr::detail
