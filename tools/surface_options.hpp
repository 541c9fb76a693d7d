// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The flags of another surface, the same for all commands that take them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "options.hpp"

namespace pgdr::tool {

/// @param purpose  what the command does with E
void add_surface(CLI::App& app, SurfaceArguments& arguments, const std::string& purpose);

}  // namespace pgdr::tool
