// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "scan/xml_tags.hpp"

namespace pgdr::detail {

void TagScanner::fail(Errc code, const std::string& message, std::uint64_t line) const {
  throw InputError(Diagnostic{code, message, file_, line, {}, {}});
}

void TagScanner::step() {
  if (text_[at_] == '\n') ++line_;
  ++at_;
}

void TagScanner::skip_space() {
  constexpr std::string_view blanks = " \n\t\r";
  while (at_ < text_.size() && blanks.find(text_[at_]) != std::string_view::npos) step();
}

std::string_view TagScanner::until(std::string_view ends) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && ends.find(text_[at_]) == std::string_view::npos) step();
  if (at_ == text_.size()) fail(Errc::truncated, "the file ends within its head", line_);
  return text_.substr(begin, at_ - begin);
}

bool TagScanner::at_end() {
  skip_space();
  return at_ == text_.size();
}

Tag TagScanner::next() {
  if (at_end()) fail(Errc::truncated, "the file ends within its head", line_);
  Tag tag;
  tag.line = line_;
  if (text_[at_] != '<') fail(Errc::syntax, quoted(until(" \n<>")) + " stands where an XML tag is expected", line_);
  step();
  if (at_ < text_.size() && text_[at_] == '?') {
    until(">");
    step();
    tag.name = "?";
    return tag;
  }
  tag.name = until(" \t\r\n>");
  for (;;) {
    skip_space();
    const std::string_view name = until("=>");
    if (text_[at_] == '>') break;
    step();
    if (at_ == text_.size() || text_[at_] != '"') fail(Errc::syntax, quoted(name) + " has no value in quotes", line_);
    step();
    tag.attributes[name] = until("\"");
    step();
  }
  step();
  return tag;
}

std::string_view TagScanner::behind(char c) {
  while (at_ < text_.size() && text_[at_] != c) step();
  if (at_ == text_.size()) fail(Errc::truncated, "the file ends before its data", line_);
  return text_.substr(at_ + 1);
}

std::string_view TagScanner::attribute(const Tag& tag, std::string_view name) const {
  const auto it = tag.attributes.find(name);
  if (it == tag.attributes.end()) fail(Errc::syntax, quoted(tag.name) + " has no " + std::string(name), tag.line);
  return it->second;
}

void TagScanner::require(const Tag& tag, std::string_view name, std::string_view value) const {
  const std::string_view found = attribute(tag, name);
  if (found != value)
    fail(Errc::unknown_format, std::string(name) + " is " + quoted(found) + ", only " + quoted(value) + " is read", tag.line);
}

std::uint64_t TagScanner::unsigned_attribute(const Tag& tag, std::string_view name) const {
  const auto value = parse_integer(attribute(tag, name));
  if (!value || *value < 0) fail(Errc::syntax, std::string(name) + " is " + quoted(attribute(tag, name)), tag.line);
  return static_cast<std::uint64_t>(*value);
}

}  // namespace pgdr::detail
