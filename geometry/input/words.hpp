// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Words and lists of diagnostics.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// "(1, 2.5, -3)", shortest digits that read back to the same doubles.
template <int D>
std::string to_text(const Point<D>& p);
/// The shortest digits that read back to the same double.
std::string to_text(double x);

/// `p` for a diagnostic.
template <int D>
std::array<double, 3> in_space(const Point<D>& p) {
  if constexpr (D == 3)
    return p.x;
  else
    return {p[0], p[1], 0};
}

/// In words at most so many culprits of one kind of repair; all are counted, and in `ids`.
inline constexpr std::size_t max_listed = 20;

/// The repairs of one kind.
struct RepairList {
  std::size_t count = 0;
  std::string words;
  Diagnostic diagnostic;
  /// Adds one; `text` is asked for only while it is listed.
  template <class Text>
  void add(Text&& text, std::initializer_list<std::int64_t> ids) {
    if (count < max_listed) words += (count == 0 ? "" : ", ") + text();
    if (count == max_listed) words += ", ...";
    ++count;
    diagnostic.ids.insert(diagnostic.ids.end(), ids);
  }
  /// Appends "<what>: <count> (<words>)" if there were any.
  void report(Errc code, const std::string& what, const std::string& file, std::vector<Diagnostic>& out);
};

}  // namespace pgdr::detail
