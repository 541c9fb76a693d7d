// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "diagnose/size_field_of_gaps.hpp"
#include "pgdr/estimate.hpp"

namespace pgdr::detail {

/// How many cells sizes ask for beyond what gaps do, `of_gaps` in all, where `gap_density(x)` is that of a place. Some thousand
/// places are looked at. @throws CancelledError, and what the sizes throw
template <int D>
double cells_of_sizes(const SizeFieldOfGaps<D>& field, const EstimateOptions<D>& options, double of_gaps,
                      const std::function<double(const Point<D>&)>& gap_density, const Bulk& bulk);

}  // namespace pgdr::detail
