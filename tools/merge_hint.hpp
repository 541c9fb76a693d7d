// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Says where --merge-points would help.
#pragma once

#include "pgdr/diagnosis.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// Of an input that is refused, on stderr. In 3D some distances are tried out; `near`: the pairs of points that nearly coincide.
template <int D>
void hint_at_merge_of_refused(const Plc<D>& plc, const FindingList& near);

/// Of one that is valid, 3D: where points miss edges and facets by no more than rounding; nothing if a distance was asked for. Into
/// the report, and, where `shown`, in a row. `domain`: of the input, if there is one already.
template <int D>
void hint_at_merge(const Plc<D>& plc, const Domain<D>* domain, bool shown, Report& report);

}  // namespace pgdr::tool
