// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is known of a mesh and of how it came to be as dicts, with the keys of the command's --report.
#pragma once

#include <pybind11/pybind11.h>

#include "mesh_data.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::python {

namespace py = pybind11;

/// The quality of all cells and of each region.
template <int D>
py::dict quality_of(const MeshData<D>& data);

/// The run but for its mesh, reasons and trace. `mesh`: that of the run.
template <int D>
py::dict to_python(const RefineResult<D>& result, const OutputMesh<D>& mesh);

}  // namespace pgdr::python
