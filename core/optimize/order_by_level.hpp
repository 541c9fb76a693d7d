// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// In which order poor cells are treated.
#pragma once

#include <cstdint>

#include "mesh/mesh.hpp"

namespace pgdr {

/// Entry::order of a cell whose quality has this level (CellQuality::level): the worst goes first, and of equals the one with the
/// lesser hash of the coordinates of its vertices, which does not depend on the unit of length.
std::uint32_t order_by_level(const Mesh<3>& mesh, CellId c, int level);

}  // namespace pgdr
