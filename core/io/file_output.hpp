// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A file that appears under its name complete or not at all: it grows under a temporary name in the same folder and is
// renamed by `commit`. Numbers are formatted straight into the buffer by std::to_chars, since for millions of them
// that is most of the time of writing. Files that mean something only together are committed together. One thread a file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pgdr::detail {

class FileOutput {
 public:
  /// @throws FileError cannot_write if no file can be made in that folder, or the target is not a regular file
  explicit FileOutput(const std::filesystem::path& target);
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  /// Removes the temporary file unless it was committed.
  ~FileOutput();

  void put(std::string_view text) {
    if (text.size() > buffer_.size() - used_) return put_long(text);
    text.copy(buffer_.data() + used_, text.size());
    used_ += text.size();
  }
  void put(char c) {
    reserve(1);
    buffer_[used_++] = c;
  }
  /// The shortest decimal that reads back to the same bits; integers in decimal.
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) void put_number(Number value) {
    reserve(longest_number);
    char* const begin = buffer_.data() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + longest_number, value).ptr - begin);
  }

  /// The bytes of a number, the least significant first.
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) void put_binary(Number value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    reserve(bytes.size());
    std::memcpy(buffer_.data() + used_, bytes.data(), bytes.size());
    used_ += bytes.size();
  }

  /// Writes what is buffered, closes, renames. The only way to make the file appear. @throws FileError cannot_write
  void commit();

  /// Makes all the files appear, or none: what was there before stays, or comes back, if one cannot be. The last file is
  /// away from before the first is replaced until all are, so that its presence means a whole set even if the process is
  /// killed. @throws FileError cannot_write
  friend void commit_together(std::span<const std::unique_ptr<FileOutput>> files);

 private:
  /// Writes what is buffered and closes.
  void finish();
  /// Renames what is finished.
  void publish();

  static constexpr std::size_t longest_number = 32;  // -1.7976931348623157e+308 has 24 characters

  void reserve(std::size_t n) {
    if (buffer_.size() - used_ < n) flush();
  }
  void put_long(std::string_view text);
  void flush();
  void write(std::string_view bytes);
  [[noreturn]] void fail(const std::string& why) const;

  std::string target_, temporary_;  // strings: libstdc++'s path does not survive a failing allocation
  std::FILE* stream_ = nullptr;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

void commit_together(std::span<const std::unique_ptr<FileOutput>> files);

}  // namespace pgdr::detail
