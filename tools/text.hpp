// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers in words, which the Python package uses as well.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pgdr::tool {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);
/// The shortest digits that read back to the same double.
std::string digits(double value);
/// 1 vertex, 2 vertices; thousands are set apart.
std::string count(std::uint64_t n, std::string_view one, std::string_view many);

/// How many letters differ: those to put in, to take out, and to change.
std::size_t letters_between(const std::string& a, const std::string& b);

/// 1 triangle, 2 tetrahedra.
template <int D>
std::string count_cells(std::uint64_t n) {
  return D == 3 ? count(n, "tetrahedron", "tetrahedra") : count(n, "triangle", "triangles");
}

}  // namespace pgdr::tool
