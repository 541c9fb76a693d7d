// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/write/valid_names.hpp"

#include <algorithm>

#include "io/formats.hpp"
#include "scan/clean_name.hpp"

namespace pgdr::detail {
namespace {

bool is_ascii_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_ascii_digit(char c) { return c >= '0' && c <= '9'; }

/// The first bytes of a name, up to the end of a character.
std::string cut(const std::string& name, std::size_t longest) {
  std::size_t end = std::min(longest, name.size());
  while (end > 0 && end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
  return name.substr(0, end);
}

std::string made_valid(std::string_view raw, const NameRule& rule) {
  const std::string clean = clean_name(raw);
  std::string name;
  for (std::string_view rest = clean; !rest.empty(); rest.remove_prefix(utf8_length(rest))) {
    const std::string_view character = rest.substr(0, utf8_length(rest));
    const char c = character.front();
    if (rule.has_blanks)
      name += c == '"' && !rule.has_quotes ? std::string_view("'") : character;
    else
      name += is_ascii_letter(c) || is_ascii_digit(c) || rule.further.find(c) != std::string_view::npos ? c : '_';
  }
  if (!rule.reserved.empty() && name.starts_with(rule.reserved)) name[rule.reserved.size() - 1] = '_';
  if (!rule.before_digit.empty() && (name.empty() || !is_ascii_letter(name.front()))) name.insert(0, rule.before_digit);
  if (name.empty()) name = "unnamed";
  return rule.longest == 0 ? name : cut(name, rule.longest);
}

}  // namespace

std::string NamePool::key(const std::string& name) const {
  std::string key = name;
  if (!rule_.has_cases)
    for (char& c : key) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return key;
}

std::string NamePool::give(std::string_view wanted) {
  const std::string base = made_valid(wanted, rule_);
  if (!rule_.are_distinct) return base;
  std::string name = base;
  for (int k = 2; !given_.insert(key(name)).second; ++k) {
    const std::string behind = std::string(1, '_').append(std::to_string(k));
    name = (rule_.longest == 0 ? base : cut(base, rule_.longest - behind.size())) + behind;
  }
  return name;
}

namespace {

/// Names that are valid as they are come first, so that no other takes one of them.
template <class Label>
std::map<Label, std::string> given_names(const std::map<Label, std::string>& names, const NameRule& rule, NamePool& pool) {
  std::map<Label, std::string> given;
  for (const bool valid : {true, false})
    for (const auto& [label, name] : names)
      if ((made_valid(name, rule) == name) == valid) given.emplace(label, pool.give(name));
  return given;
}

}  // namespace

Names valid_names(const Names& names, const NameRule& rule) {
  NamePool of_regions(rule), of_markers(rule);
  Names valid{given_names(names.regions, rule, of_regions), names.markers};
  if (rule.of_markers.empty()) {
    valid.markers = given_names(names.markers, rule, of_markers);
    return valid;
  }
  for (auto& [marker, name] : valid.markers)
    if (std::string own = made_valid(name, rule); of_regions.has(own))
      name = cut(own, rule.longest - rule.of_markers.size()).append(rule.of_markers);
  valid.markers = given_names(valid.markers, rule, of_regions);
  return valid;
}

const NameRule& name_rule(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (is_foam_mesh(file)) return foam_names;
  if (extension == ".msh") return msh_names;
  if (extension == ".inp") return abaqus_names;
  if (extension == ".mfem") return mfem_names;
  return text_names;
}

}  // namespace pgdr::detail
