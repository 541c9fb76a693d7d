// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How everything that this library writes comes to its name. A file appears whole or not at all: it grows under a temporary name
// in its folder, and replaces what was there, whose permissions it takes over. Symbolic links are followed, and stay. Devices and
// FIFOs are written to; so is what the process has open already, by its name in /dev/fd (/dev/stdout). Nothing else is touched:
// folders, sockets, and files that may not be written are errors. A FIFO is waited for; who writes to one that nobody reads any
// more gets SIGPIPE, unless that is ignored, and then an error. Any thread.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// Writes what `write` puts out. What it throws comes through, and an older file stays.
/// @throws FileError cannot_write
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// Asks what can be known without writing: whether there is a folder in which a file can be made, which is tried, and nothing of
/// that name that may not be replaced or written to. @throws FileError cannot_write
void require_writable(const std::filesystem::path& file);

/// The place that is written under a name: that of the file behind all links, also where there is none yet. The name itself of
/// what is no file. @throws FileError cannot_write for links in a circle, and what cannot be written
std::filesystem::path place_of_output(const std::filesystem::path& file);

/// Is something of this name written to, and not replaced? Whoever writes to it may have to wait.
/// @throws as place_of_output
bool is_written_to(const std::filesystem::path& file);

/// Removes a file that was written, where its links lead. Nothing that is no file, no link, and no error.
void remove_output(const std::string& file) noexcept;

}  // namespace pgdr
