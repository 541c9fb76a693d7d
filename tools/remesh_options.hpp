// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The flags of meshes that are inputs, and units of sizes.
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace pgdr::tool {

void add_remesh_options(CLI::App& app, MeshArguments& arguments);
void add_refine_options(CLI::App& app, MeshArguments& arguments);
/// Of `check`, with --input.
void add_remeshed(CLI::App& app, CheckArguments& arguments);
void add_size_unit(CLI::App& app, BoundArguments& arguments);

}  // namespace pgdr::tool
