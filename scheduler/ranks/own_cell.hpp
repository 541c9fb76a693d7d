// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "mesh/ids.hpp"

namespace pgdr::detail {

/// Is the cell one of this rank's own? Asked on several threads, while only that cell may be read. Each cell of the whole mesh is
/// one of exactly one rank.
using IsOwnCell = std::function<bool(CellId)>;

}  // namespace pgdr::detail
