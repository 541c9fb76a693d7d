// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Questions about file names that are asked before any work is done, and how files of text are written.
#pragma once

#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <vector>

namespace pgdr::tool {

/// Upper or lower case.
bool has_extension(const std::string& file, std::initializer_list<const char*> extensions);
/// What can be known of the output file without writing it is said before the work, not after it.
/// @throws InputError unknown_format, FileError cannot_write, UsageError if it would replace the input.
void require_writable(const std::string& output, const std::string& input);
/// The same of a file of any name. @throws FileError cannot_write, UsageError if it is one of the others.
void require_writable(const std::string& file, const std::vector<std::string>& others);

/// Writes to a temporary name beside `file` and renames it. @param what the subject of "... cannot be written".
/// @throws FileError cannot_write
void write_whole(const std::string& file, const char* what, const std::function<void(std::ostream&)>& write);

}  // namespace pgdr::tool
