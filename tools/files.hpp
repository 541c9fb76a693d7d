// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Questions about file names that are asked before any work is done, and how files of text are written.
#pragma once

#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <string>

namespace pgdr::tool {

/// Upper or lower case.
bool has_extension(const std::string& file, std::initializer_list<const char*> extensions);
/// What can be known of a file without writing it is said before the work, not after it. @throws FileError cannot_write
void require_writable(const std::string& file);
/// The same of all files of a mesh. @throws InputError unknown_format, FileError cannot_write
void require_mesh_writable(const std::string& output);

/// Meshes in formats that are no inputs are refused with what can be done. @throws InputError unknown_format
void require_input_format(const std::string& file);

/// Writes to a temporary name beside `file` and renames it. @param what the subject of "... cannot be written".
/// @throws FileError cannot_write
void write_whole(const std::string& file, const char* what, const std::function<void(std::ostream&)>& write);

}  // namespace pgdr::tool
