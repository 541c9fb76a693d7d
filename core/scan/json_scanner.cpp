// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "scan/json_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_depth = 64;  // what is nested deeper is no geometry, and would take the stack

constexpr bool is_json_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
constexpr bool is_in_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E'; }

void append_utf8(std::uint32_t code, std::string& to) {
  const auto put = [&to](std::uint32_t byte) { to += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xc0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3f));
  } else {
    put(0xf0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3f));
    put(0x80 | (code >> 6 & 0x3f));
  }
  put(0x80 | (code & 0x3f));
}

}  // namespace

JsonScanner::JsonScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with("\xEF\xBB\xBF")) pos_ = 3;
}

std::uint32_t JsonScanner::line() const {
  const auto [low, high] = std::minmax(counted_, pos_);
  const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(low), end = text_.begin() + static_cast<std::ptrdiff_t>(high);
  const auto ends = static_cast<std::uint32_t>(std::count(begin, end, '\n'));
  line_ = counted_ < pos_ ? line_ + ends : line_ - ends;
  counted_ = pos_;
  return line_;
}

void JsonScanner::fail(Errc code, const std::string& message, const std::vector<std::int64_t>& ids) const {
  throw InputError(Diagnostic{code, message, file_, line(), ids, {}});
}

char JsonScanner::next() {
  while (pos_ < text_.size() && is_json_blank(text_[pos_])) ++pos_;
  if (pos_ == text_.size()) fail(Errc::truncated, "the file ends where more is expected");
  return text_[pos_];
}

void JsonScanner::return_to(std::size_t place) { pos_ = place; }

void JsonScanner::open(char bracket, const char* what) {
  if (next() != bracket) fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " stands where " + what + " is expected");
  if (++depth_ > most_depth)
    fail(Errc::syntax, "objects and arrays are nested more than " + std::to_string(most_depth) + " deep");
  ++pos_;
}

bool JsonScanner::more(char bracket, bool first) {
  const char c = next();
  if (c == bracket) {
    ++pos_;
    --depth_;
    return false;
  }
  if (first) return true;
  if (c != ',') fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " stands where a comma or the end of a list is expected");
  ++pos_;
  if (next() == bracket) fail(Errc::syntax, "a list ends with a comma");
  return true;
}

void JsonScanner::colon() {
  if (next() != ':') fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " stands where a colon is expected");
  ++pos_;
}

std::uint32_t JsonScanner::four_digits() {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i, ++pos_) {
    const char c = pos_ < text_.size() ? text_[pos_] : '\0';
    const bool digit = c >= '0' && c <= '9', letter = (c | 32) >= 'a' && (c | 32) <= 'f';
    if (!digit && !letter) fail(Errc::syntax, "\\u is not followed by four hexadecimal digits");
    value = value << 4 | static_cast<std::uint32_t>(digit ? c - '0' : (c | 32) - 'a' + 10);
  }
  return value;
}

/// What stands behind a backslash.
void JsonScanner::escape(std::string& to) {
  constexpr std::string_view names = "\"\\/bfnrt", values = "\"\\/\b\f\n\r\t";
  const char c = pos_ < text_.size() ? text_[pos_++] : '\0';
  if (const std::size_t i = names.find(c); i != std::string_view::npos) {
    to += values[i];
    return;
  }
  if (c != 'u') fail(Errc::syntax, "a string has the unknown escape " + quoted(std::string_view(&c, 1)));
  std::uint32_t code = four_digits();
  if (code >= 0xd800 && code < 0xdc00 && text_.substr(pos_).starts_with("\\u")) {
    pos_ += 2;
    const std::uint32_t low = four_digits();
    code = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : 0xfffd;
  } else if (code >= 0xd800 && code < 0xe000) {
    code = 0xfffd;
  }
  append_utf8(code, to);
}

std::string JsonScanner::string() {
  if (next() != '"') fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " stands where a string is expected");
  ++pos_;
  std::string made;
  for (;;) {
    if (pos_ == text_.size()) fail(Errc::truncated, "the file ends within a string");
    const char c = text_[pos_++];
    if (c == '"') return made;
    if (static_cast<unsigned char>(c) < ' ') fail(Errc::syntax, "a string has a control character or ends with its line");
    if (c == '\\')
      escape(made);
    else
      made += c;
  }
}

double JsonScanner::number() {
  next();
  std::size_t end = pos_;
  while (end < text_.size() && is_in_number(text_[end])) ++end;
  const std::string_view token = text_.substr(pos_, end - pos_);
  const auto value = token.starts_with('+') ? std::nullopt : parse_double(token);
  if (!value) fail(Errc::syntax, quoted(text_.substr(pos_, std::max<std::size_t>(token.size(), 1))) + " is not a number");
  if (!std::isfinite(*value)) fail(Errc::not_finite, quoted(token) + " is not finite");
  pos_ = end;
  return *value;
}

void JsonScanner::literal(std::string_view word) {
  if (!text_.substr(pos_).starts_with(word)) fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " is no value");
  pos_ += word.size();
}

bool JsonScanner::null() {
  if (next() != 'n') return false;
  literal("null");
  return true;
}

void JsonScanner::skip() {
  switch (next()) {
    case '{': return object([this](const std::string&) { skip(); });
    case '[': return array([this] { skip(); });
    case '"': string(); return;
    case 't': return literal("true");
    case 'f': return literal("false");
    case 'n': return literal("null");
    default: number();
  }
}

void JsonScanner::end() {
  while (pos_ < text_.size() && is_json_blank(text_[pos_])) ++pos_;
  if (pos_ < text_.size()) fail(Errc::syntax, quoted(text_.substr(pos_, 1)) + " stands behind the end");
}

}  // namespace pgdr::detail
