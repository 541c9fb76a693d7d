// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The flags of `view`.
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace pgdr::tool {

void add_view(CLI::App& app, ViewArguments& arguments);

}  // namespace pgdr::tool
