// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is said before a mesh is made: how many cells it takes at least, and which entities of the input are nearest to each
// other.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bounds.hpp"
#include "options.hpp"
#include "pgdr/estimate.hpp"
#include "pgdr/region_mode.hpp"
#include "report.hpp"

namespace pgdr::tool {

template <int D>
struct Outlook {
  std::optional<Gap<D>> gap;
  std::optional<SharpAngle<D>> angle;
  std::optional<CellEstimate<D>> estimate;  ///< none where nothing is refined
};

/// @throws CancelledError
template <int D>
Outlook<D> look_ahead(const Domain<D>& domain, const Bounds<D>& bounds, bool refines, RegionMode regions,
                      const std::stop_token& stop);

/// In the report as `estimated_cells` and `narrowest_gap`.
template <int D>
void set_outlook(Report& report, const Domain<D>& domain, const Outlook<D>& outlook);
/// In rows, at once.
template <int D>
void print_outlook(const Domain<D>& domain, const Outlook<D>& outlook);

}  // namespace pgdr::tool
