// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "space/system.hpp"

namespace pgdr::detail {

/// Asks for huge pages for [memory, memory + bytes) where that is large: a hint. @pre nothing was written to it
/// An empty vector with room for so many, on huge pages where that is much.
template <class T>
std::vector<T> vector_of_capacity(std::size_t count) {
  std::vector<T> v;
  v.reserve(count);
  system::ask_for_huge_pages(v.data(), count * sizeof(T));
  return v;
}

}  // namespace pgdr::detail
