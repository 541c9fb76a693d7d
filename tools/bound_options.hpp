// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The flags of the bounds that `mesh` makes and `check` verifies.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "options.hpp"

namespace pgdr::tool {

/// @param without  what holds if --radius-edge is not given
/// @param without_dihedral  likewise
/// @returns the option --min-dihedral
CLI::Option* add_bounds(CLI::App& app, BoundArguments& b, const std::string& without, const std::string& without_dihedral);

}  // namespace pgdr::tool
