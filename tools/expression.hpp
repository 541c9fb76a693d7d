// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes as text: a number, or an expression in x, y (and z in 3D), evaluated by muParser. A parser keeps the values of
// its variables inside, so concurrent calls take one parser each from a small set.
#pragma once

#include <string>

#include "pgdr/sizing.hpp"

namespace pgdr::tool {

/// The size field that `text`, the value of `flag`, stands for; may be called from any number of threads.
/// @throws UsageError bad_option if it is not an expression in the coordinates, or a constant that is not positive.
template <int D>
SizingField<D> parse_size(const std::string& text, const std::string& flag);

}  // namespace pgdr::tool
