// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A file that several processes write at once, each at places of its own. Bytes go out in slices that end at multiples of a
// mebibyte, so that no two processes write to the same part of the disk but at the ends of what they have. One thread a writer.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pgdr::detail {

class FileSlices {
 public:
  /// @param name  of a file that is there
  /// @param target  what it is called in messages
  /// @throws FileError cannot_write
  FileSlices(const std::string& name, std::string target);
  FileSlices(const FileSlices&) = delete;
  FileSlices& operator=(const FileSlices&) = delete;
  ~FileSlices();

  /// What is put next goes to this place, counted in bytes. @throws FileError cannot_write
  void begin_at(std::uint64_t place);
  /// @throws FileError cannot_write (no space, an error of the disk, ...)
  void put(std::string_view bytes);
  /// Writes what is left, and closes. Network file systems say here what went wrong. @throws FileError cannot_write
  void close();

 private:
  void write(std::string_view bytes);
  [[noreturn]] void fail(int error_number) const;

  std::string target_;
  std::string waiting_;      // fewer bytes than reach the next multiple
  std::uint64_t place_ = 0;  // of the first of them
  int file_ = -1;
};

}  // namespace pgdr::detail
