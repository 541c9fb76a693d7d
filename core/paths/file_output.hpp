// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A file that appears under its name complete or not at all: it grows under a temporary name in the same folder and is
// renamed by `commit`. What is no file is written to instead (write_target.hpp). Numbers are formatted straight into the buffer
// by std::to_chars, since for millions of them that is most of the time of writing, and side by side where there are threads.
// Files that mean something only together are committed together. One thread a file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "paths/write_target.hpp"

namespace pgdr::detail {

/// Text and bytes, as they are put one after the other.
class TextBuffer {
 public:
  explicit TextBuffer(std::size_t room = 0) : buffer_(room) {}
  virtual ~TextBuffer() = default;

  void put(std::string_view text) {
    reserve(text.size());
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

  /// What has been put, but for what has gone elsewhere since.
  std::string_view text() const { return {buffer_.data(), used_}; }
  void clear() { used_ = 0; }
  /// As clear(), and gives the memory back.
  void release() {
    clear();
    buffer_ = {};
  }

 protected:
  /// Makes room for n more bytes.
  virtual void make_room(std::size_t n) { buffer_.resize(std::max(used_ + n, 2 * buffer_.size())); }
  std::size_t room() const { return buffer_.size(); }

 private:
  static constexpr std::size_t longest_number = 32;  // -1.7976931348623157e+308 has 24 characters

  void reserve(std::size_t n) {
    if (buffer_.size() - used_ < n) make_room(n);
  }

  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

/// Puts items [first, last) of some.
using PutBlock = std::function<void(TextBuffer&, std::size_t first, std::size_t last)>;
/// Gives `sink` the bytes of `count` items, in their order. Blocks are put side by side, on the threads of the caller's arena.
void put_in_blocks(std::size_t count, const PutBlock& put_block, const std::function<void(std::string_view)>& sink);

/// A whole file under a temporary name.
struct PendingFile {
  std::string temporary, target;
};
/// Makes all the files appear, or none: what was there before stays, or comes back, if one cannot be. The last file is
/// away from before the first is replaced until all are, so that its presence means a whole set even if the process is
/// killed. @throws FileError cannot_write
void publish_together(std::span<const PendingFile> files);

class FileOutput final : public TextBuffer {
 public:
  /// @throws FileError cannot_write if no file can be made in that folder, or what is there can be neither replaced nor written
  /// to
  explicit FileOutput(const std::filesystem::path& target);
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  /// Removes the temporary file unless it was committed.
  ~FileOutput() override;

  /// What put_item(text, i) puts for i < count, in their order. Side by side in blocks, on the threads of the caller's arena.
  template <class PutItem>
  void put_each(std::size_t count, const PutItem& put_item) {
    put_blocks(count, [&put_item](TextBuffer& text, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) put_item(text, i);
    });
  }

  /// As put_each, of what puts whole blocks.
  void put_blocks(std::size_t count, const PutBlock& put_block);

  /// Is this written to as it grows? It has no temporary name then, is opened when the first bytes go there, and is there at
  /// once.
  bool is_stream() const { return target_.is_stream(); }
  /// Its two names, once it is closed; whoever renames it says so by set_published(). @pre !is_stream()
  PendingFile pending() const { return {temporary_, target_.name}; }
  void set_published() { temporary_.clear(); }
  /// Writes what is buffered and closes, so that nothing more can be put. Gives the memory back. @throws FileError cannot_write
  void close();
  /// Writes what is buffered, closes, renames. The only way to make the file appear. @throws FileError cannot_write
  void commit();

 private:
  void make_room(std::size_t n) override;
  void flush();
  void write(std::string_view bytes);
  void open_temporary();
  void open_stream();

  WriteTarget target_;
  std::string temporary_;
  std::FILE* stream_ = nullptr;
  bool closed_ = false;
};

/// Closes the files and publishes them together. @throws FileError cannot_write
void commit_together(std::span<const std::unique_ptr<FileOutput>> files);

}  // namespace pgdr::detail
