// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// simplex_shapes() as it is on processors that are not known to do more, by a name of its own, so that tests can compare.
#pragma once

#include "numbers/simplex_shapes.hpp"

namespace pgdr::detail {

template <int D>
void simplex_shapes_anywhere(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out);

}  // namespace pgdr::detail
