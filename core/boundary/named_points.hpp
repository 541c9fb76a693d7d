// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Words for errors that are found after a Domain was made: they name points of the input. Pure functions, any thread.
#pragma once

#include <span>
#include <string>

#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"

namespace pgdr::detail {

/// A diagnostic about these domain points, with their numbers in the input and coordinates, the file, and the line of the first.
template <int D>
Diagnostic about_points(Errc code, const Domain<D>& domain, std::span<const std::uint32_t> points);

/// "the segment between points 3 and 4", and "the facet through points 3, 4, 9, ...", by the `ids` of what is about their points.
std::string segment_words(const Diagnostic& about);
std::string facet_words(const Diagnostic& about);

}  // namespace pgdr::detail
