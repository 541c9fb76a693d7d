// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the volumes that walls enclose are solid, if nothing but their nesting says so (core's RegionMode::automatic).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pgdr::detail {

/// Whether each volume is solid, from the pairs of neighbours (of different volumes, in any order, any number of times).
/// Volume 0 is the outside. Linear time. Volumes that cannot be reached from the outside are not.
std::vector<bool> solid_by_nesting(std::uint32_t volumes, std::vector<std::array<std::uint32_t, 2>> neighbours);

}  // namespace pgdr::detail
