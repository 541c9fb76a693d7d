// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Words of the report, which the Python package uses as well.
#pragma once

#include <array>

#include "pgdr/poor_reason.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/types.hpp"

namespace pgdr::tool {

inline constexpr std::array<const char*, 7> code_names{"small_angle",    "rounding",  "beyond_theory", "kept_boundary",
                                                       "input_dihedral", "not_found", "budget"};  ///< of PoorReason::Code
inline constexpr std::array<const char*, 4> kind_names{"vertex", "segment", "facet", "volume"};   ///< of EntityKind

inline const char* name(PoorReason::Code code) { return code_names[static_cast<std::size_t>(code)]; }
inline const char* name(EntityKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

inline const char* name(StopCause cause) {
  switch (cause) {
    case StopCause::max_vertices: return "max_vertices";
    case StopCause::min_edge: return "min_edge";
    case StopCause::time_limit: return "time_limit";
    case StopCause::cancelled: return "cancelled";
    case StopCause::finished: break;
  }
  return "finished";
}

}  // namespace pgdr::tool
