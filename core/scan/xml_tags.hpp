// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Tags of XML, one after the other, as VTK's files have them: no text between, attributes in double quotes. What is wrong is an
// InputError with file and line. One thread a scanner.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "pgdr/error.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {

/// "<Name a="v" b="w">", "</Name>" or "<?...?>".
struct Tag {
  std::string_view name;  ///< with its '/' if it closes, "?" for a declaration
  std::map<std::string_view, std::string_view> attributes;
  std::uint64_t line = 0;
};

class TagScanner {
 public:
  TagScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Tag next();                                   ///< what the file ends before is truncated
  bool at_end();                                ///< is there nothing but blanks?
  std::string_view behind(char c);              ///< what follows the next c
  std::uint64_t line() const { return line_; }  ///< of what comes next

  std::string_view attribute(const Tag& tag, std::string_view name) const;
  std::uint64_t unsigned_attribute(const Tag& tag, std::string_view name) const;
  /// Refuses (unknown_format) an attribute with another value.
  void require(const Tag& tag, std::string_view name, std::string_view value) const;
  [[noreturn]] void fail(Errc code, const std::string& message, std::uint64_t line) const;

 private:
  void step();
  void skip_space();
  /// Up to, and over, one of `ends`.
  std::string_view until(std::string_view ends);

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 1;
};

}  // namespace pgdr::detail
