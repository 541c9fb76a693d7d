// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Words and numbers out of a text that lies in memory, line by line, with errors that name the line and the culprit.
// Blank lines and '#' comments are never seen by the caller, commas count as blanks (TetGen's readers skip them, and
// files with them exist). No locale, no allocation but for errors. Formats that put binary parts into a text take these
// with `bytes`; errors count the lines through them, as an editor would. One thread a scanner.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::detail {

/// What is being read, for messages: "point 7", or "the list of facets" without a number.
struct Subject {
  std::string_view what;
  std::int64_t id = -1;  ///< in the numbering of the file; -1: none
};

/// Quoted, printable and short, for a message.
std::string quoted(std::string_view token);

class LineScanner {
 public:
  /// Views `text`, which must outlive the scanner. A byte order mark is skipped.
  LineScanner(std::string_view text, std::string file);

  std::uint64_t line() const { return line_; }  ///< of a text without binary parts before
  /// Bytes from here to the end of the text.
  std::size_t remaining() const { return text_.size() - pos_; }
  /// The same bytes, to look ahead.
  std::string_view rest() const { return text_.substr(pos_); }

  /// Whether another word follows on this line.
  bool more_on_line();
  /// Moves to the next word, over the ends of lines. @returns false at the end of the text
  bool advance();
  /// The same, but the text must not end: @throws truncated.
  void require(Subject s);
  /// Leaves a line that must be used up (@throws syntax) and moves to the next word (@throws truncated).
  void next_line(Subject s);
  /// @throws syntax unless the line is used up.
  void end_line(Subject s);
  /// Leaves the line, whatever it still holds.
  void skip_line();
  /// What is left of the line as it stands, comments and all.
  std::string_view rest_of_line();
  /// Leaves a line that must be used up and stands at the first byte behind it. @throws syntax, truncated
  void enter_bytes(Subject s);
  /// The next `n` bytes, whatever they are. @throws truncated
  std::string_view bytes(Subject s, std::size_t n);

  /// The next character, behind `advance`.
  char peek() const { return pos_ < text_.size() ? text_[pos_] : '\0'; }
  /// Steps over `literal` if the text goes on with it, be it within a word.
  bool accept(std::string_view literal);
  /// The next word on this line. @throws syntax (truncated if the text ends) if there is none
  std::string_view word(Subject s);
  /// An integer of the range of T. @throws syntax
  std::int64_t integer(Subject s);
  int marker(Subject s);
  /// Any number; infinities and NaN only if `finite` is false. @throws syntax, not_finite
  double number(Subject s, bool finite = true);
  /// A count of things of which each takes at least `bytes_each` bytes of the text. @throws count_too_large
  /// (truncated if the count is small), syntax
  std::size_t count(Subject s, std::size_t bytes_each);
  /// The same of a count that is known already.
  void check_count(Subject s, std::uint64_t n, std::size_t bytes_each) const;
  /// A reference to one of `n` points numbered from `first`; returned from 0. @throws index_out_of_range, syntax
  std::uint32_t reference(Subject s, std::uint32_t first, std::size_t n);

  /// Throws an InputError that points at the current line.
  [[noreturn]] void fail(Errc code, const std::string& message, const std::vector<std::int64_t>& ids = {}) const;

 private:
  void skip_blanks();
  std::string_view take();
  [[noreturn]] void fail_at(Errc code, Subject s, std::string_view token, std::string_view why) const;

  std::string_view text_;
  std::string file_;
  std::size_t pos_ = 0;
  std::uint64_t line_ = 1;
};

/// Parses all of `token` as a decimal number, a leading '+' allowed; what underflows is 0, what overflows is infinite.
std::optional<double> parse_double(std::string_view token);
std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace pgdr::detail
