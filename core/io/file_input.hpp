// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A whole file in memory: what all readers start from, so that each count can be held against the bytes there are.
#pragma once

#include <filesystem>
#include <string>

namespace pgdr::detail {

/// @throws FileError cannot_open for anything that is missing, a directory, or cannot be read to its end.
std::string read_whole_file(const std::filesystem::path& file);

}  // namespace pgdr::detail
