// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is written under a name. A file is replaced as a whole, where the links of its name lead, and only if it may be written;
// what is no file is written to. Strings all along: libstdc++'s path does not survive a failing allocation.
#pragma once

#include <string>

namespace pgdr::detail {

/// Is it a stream_name()? It has an extension.
bool names_stream(const std::string& file);

struct WriteTarget {
  enum class Kind {
    new_file,
    old_file,   ///< a regular file, which may be written
    stream,     ///< a device or FIFO, which is opened by its name
    descriptor  ///< one that this process has open, by its name in /dev/fd or /proc/self/fd: /dev/stdout, say
  };
  Kind kind = Kind::new_file;
  std::string name;     ///< of a file with its links followed, also where these lead to nothing yet; of others as it was given
  int descriptor = -1;  ///< of that kind

  bool is_stream() const { return kind == Kind::stream || kind == Kind::descriptor; }
};

/// @throws FileError cannot_write for what can be neither replaced nor written to: a folder, a socket, a file without permission,
///   links in a circle
WriteTarget target_of(const std::string& file);

/// The folder of a name, with its slash; "./" where it has none.
std::string folder_of(const std::string& file);

/// Why `file` cannot be written, with the number of an error of the system, or in words. @throws FileError cannot_write
[[noreturn]] void cannot_write(const std::string& file, int error_number);
[[noreturn]] void cannot_write(const std::string& file, const char* why);

}  // namespace pgdr::detail
