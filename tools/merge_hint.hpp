// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Says where --merge-points would help.
#pragma once

#include <cstddef>
#include <optional>

#include "options.hpp"
#include "pgdr/diagnosis.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// Of an input that is refused, on stderr. In 3D some distances are tried out; `near`: the pairs of points that nearly coincide.
template <int D>
void hint_at_merge_of_refused(const Plc<D>& plc, const FindingList& near);

/// Says what is merged as the numbers of the file are floats (set_merge_of_file), if nobody asked for a distance.
template <int D>
void note_merge(const Plc<D>& plc, const InputArguments& reading);

/// Of one that is valid, 3D: where points miss edges and facets by no more than rounding.
struct MergeHint {
  double merge_points;
  std::size_t points;  ///< that it joins
};
/// Nothing if a distance was asked for, or for lack of memory. @param domain  of `plc`; null: not at hand
template <int D>
std::optional<MergeHint> find_merge_hint(const Plc<D>& plc, const Domain<D>* domain);
/// In the report as `merge_hint`, and in a row where `shown`.
void give(const std::optional<MergeHint>& hint, bool shown, Report& report);

}  // namespace pgdr::tool
