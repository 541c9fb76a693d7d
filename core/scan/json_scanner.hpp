// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// JSON (RFC 8259) out of a text that lies in memory, taken as it comes, without a tree of values. Errors name line and culprit,
// as those of LineScanner. One thread a scanner.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pgdr/error.hpp"

namespace pgdr::detail {

class JsonScanner {
 public:
  /// Views `text`, which must outlive the scanner. A byte order mark is skipped.
  JsonScanner(std::string_view text, std::string file);

  /// The first character of the next value: { [ " - 0 to 9 t f n. @throws truncated, syntax
  char next();
  /// Takes an object: f(name) for each member, which must take its value. @throws syntax, truncated
  template <class F>
  void object(const F& f) {
    open('{', "an object");
    for (bool first = true; more('}', first); first = false) {
      const std::string name = string();
      colon();
      f(name);
    }
  }
  /// Takes an array: f() for each value, which must take it. @throws syntax, truncated
  template <class F>
  void array(const F& f) {
    open('[', "an array");
    for (bool first = true; more(']', first); first = false) f();
  }
  /// Takes a string, in UTF-8. @throws syntax, truncated
  std::string string();
  /// Takes a finite number. @throws syntax, not_finite, truncated
  double number();
  /// Takes null, if it is the next value.
  bool null();
  /// Takes any value.
  void skip();
  /// @throws syntax unless nothing but blanks is left
  void end();

  std::uint32_t line() const;
  /// Throws an InputError that points at the current line.
  [[noreturn]] void fail(Errc code, const std::string& message, const std::vector<std::int64_t>& ids = {}) const;
  /// Where the scanner stands, and back to there.
  std::size_t place() const { return pos_; }
  void return_to(std::size_t place);

 private:
  void open(char bracket, const char* what);
  bool more(char bracket, bool first);
  void colon();
  void literal(std::string_view word);
  void escape(std::string& to);
  std::uint32_t four_digits();

  std::string_view text_;
  std::string file_;
  std::size_t pos_ = 0;
  int depth_ = 0;
  mutable std::size_t counted_ = 0;  ///< the line of this place is known
  mutable std::uint32_t line_ = 1;
};

}  // namespace pgdr::detail
