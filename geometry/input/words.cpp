// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/words.hpp"

#include <charconv>
#include <utility>

namespace pgdr::detail {

std::string to_text(double x) {
  char digits[40];
  return {digits, std::to_chars(digits, digits + sizeof digits, x).ptr};
}

template <int D>
std::string to_text(const Point<D>& p) {
  std::string s = "(";
  for (int i = 0; i < D; ++i) s += (i == 0 ? "" : ", ") + to_text(p[i]);
  return s + ")";
}
template std::string to_text<2>(const Point2&);
template std::string to_text<3>(const Point3&);

void RepairList::report(Errc code, const std::string& what, const std::string& file, std::vector<Diagnostic>& out) {
  if (count == 0) return;
  diagnostic.code = code;
  diagnostic.file = file;
  diagnostic.message = what + ": " + std::to_string(count) + " (" + words + ")";
  out.push_back(std::move(diagnostic));
}

}  // namespace pgdr::detail
