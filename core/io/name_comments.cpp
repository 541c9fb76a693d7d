// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names where a format has no place for them but comments and attributes of XML.
#include <cmath>
#include <string>

#include "input/words.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "scan/clean_name.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr std::string_view of_region = "# name region ", of_marker = "# name marker ";

/// What stands for a character in an attribute of XML.
struct XmlEscape {
  char character;
  std::string_view text;
};
constexpr XmlEscape xml_escapes[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}};

}  // namespace

std::string name_comments(const Names& names) {
  const Names valid = valid_names(names, text_names);
  std::string out;
  for (const auto& [label, name] : valid.regions) out.append(of_region).append(to_text(label)).append(" = ").append(name) += '\n';
  for (const auto& [marker, name] : valid.markers)
    out.append(of_marker).append(std::to_string(marker)).append(" = ").append(name) += '\n';
  return out;
}

Names read_name_comments(std::string_view head, const std::string& file) {
  Names names;
  for (std::uint64_t line_number = 1; !head.empty(); ++line_number) {
    const std::string_view line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    const bool is_region = line.starts_with(of_region);
    if (!is_region && !line.starts_with(of_marker)) continue;
    const std::string_view rest = line.substr(of_region.size());
    const std::size_t equals = rest.find(" = ");
    const auto label = parse_double(rest.substr(0, equals));
    const auto marker = parse_integer(rest.substr(0, equals));
    std::string name = clean_name(equals == std::string_view::npos ? std::string_view() : rest.substr(equals + 3));
    const bool is_number = is_region ? label && !std::isnan(*label) : marker && *marker == static_cast<int>(*marker);
    if (name.empty() || !is_number)
      throw InputError(
          Diagnostic{Errc::syntax, "the comment " + quoted(line) + " gives nothing a name", file, line_number, {}, {}});
    if (is_region)
      names.regions[*label] = std::move(name);
    else
      names.markers[static_cast<int>(*marker)] = std::move(name);
  }
  return names;
}

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    std::string_view as = {&c, 1};
    for (const XmlEscape& escape : xml_escapes)
      if (escape.character == c) as = escape.text;
    out += as;
  }
  return out;
}

std::string xml_unescaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t taken = 1;
    char c = text.front();
    for (const XmlEscape& escape : xml_escapes)
      if (text.starts_with(escape.text)) {
        taken = escape.text.size();
        c = escape.character;
      }
    out += c;
    text.remove_prefix(taken);
  }
  return out;
}

}  // namespace pgdr::detail
