// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Questions about file names that are asked before any work is done.
#pragma once

#include <string>

namespace pgdr::tool {

/// True iff the extension is that of a mesh (read and written), not of an input.
bool is_mesh_file(const std::string& file);

/// What can be known of the output file without writing it is said before the work, not after it.
/// @throws InputError unknown_format, FileError cannot_write, UsageError if it would replace the input.
void require_writable(const std::string& output, const std::string& input);

}  // namespace pgdr::tool
