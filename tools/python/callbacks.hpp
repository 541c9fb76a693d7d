// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Functions of Python as size functions and selectors of the library, called from its threads: each takes the GIL for one block.
// What they get are copies, so that a function may keep them; what they return is checked.
#pragma once

#include <pybind11/pybind11.h>

#include "errors.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr::python {

/// Sizes by f(points), points being (n, D) and the result (n,).
/// @throws PythonError, when asked: what f raises; UsageError for results of another shape or type
template <int D>
SizingField<D> sizes_by(py::function f);

/// Points by f(elements), elements being an Elements of pgdr/_run.py, and the result (n, D). Errors as those of sizes_by.
template <int D>
PointSelector<D> selector_by(py::function f);

}  // namespace pgdr::python
