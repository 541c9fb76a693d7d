// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The yardstick of tolerances: how large a model is.
#pragma once

#include "space/box.hpp"

namespace pgdr::detail {

/// The diagonal of a box, without overflow of squares. @pre it is not empty
template <int D>
double diagonal_of(const Box<D>& box);

}  // namespace pgdr::detail
