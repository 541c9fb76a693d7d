// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names as the formats can hold them. What one cannot is made valid in the same way each time: a function of all names alone.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "pgdr/names.hpp"

namespace pgdr::detail {

/// What a format allows of a name.
struct NameRule {
  bool has_blanks = false;        ///< any character of UTF-8 but control characters and double quotes; else letters, digits and
  bool has_quotes = false;        ///< then double quotes, too
  std::string_view further;       ///< these; others become '_'
  std::string_view before_digit;  ///< what comes before a name that would not begin with a letter; empty: it may
  std::size_t longest = 0;        ///< in bytes; 0: as long as it likes
  bool has_cases = true;          ///< are capital letters others than small ones?
  bool are_distinct = true;       ///< may no two labels have the same?
  std::string_view of_markers;    ///< what comes behind the name of a marker that a region has, too; empty: both may have it
  std::string_view reserved;      ///< what a name must not begin with: the blank behind it becomes '_'
};

inline constexpr NameRule msh_names{.has_blanks = true, .longest = 127, .are_distinct = false, .reserved = "pgdr "};
inline constexpr NameRule mfem_names{.has_blanks = true, .are_distinct = false};
inline constexpr NameRule text_names{.has_blanks = true, .has_quotes = true, .are_distinct = false};
/// Abaqus's manual, "Data types, labels": a letter first, up to 80 characters, and capital letters are no others. CalculiX 2.20
/// takes a surface for the element set of its name where it counts loads, and ends.
inline constexpr NameRule abaqus_names{
    .further = "_-", .before_digit = "SET_", .longest = 80, .has_cases = false, .of_markers = "_SURFACE"};
/// What OpenFOAM takes for a word; one that begins with a digit is read as a number.
inline constexpr NameRule foam_names{.further = "_-.+:", .before_digit = "part_"};

/// Names that are given one after the other under a rule.
class NamePool {
 public:
  explicit NamePool(const NameRule& rule) : rule_(rule) {}
  /// `wanted` made valid; with "_2", "_3", ... behind it if it was given before and may not be given again.
  std::string give(std::string_view wanted);
  /// Was it given, or another that is the same here?
  bool has(const std::string& name) const { return given_.contains(key(name)); }

 private:
  std::string key(const std::string& name) const;

  NameRule rule_;
  std::set<std::string> given_;
};

/// All names under a rule.
Names valid_names(const Names& names, const NameRule& rule);

/// The rule of the format that a file of this name has. Formats whose names go into comments or into XML take any.
const NameRule& name_rule(const std::filesystem::path& file);

}  // namespace pgdr::detail
