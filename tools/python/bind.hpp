// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What each source adds to the module pgdr._pgdr. A class or function of D dimensions bears D at the end of its name: Plc2, Plc3.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace pgdr::python {

namespace py = pybind11;

template <int D>
std::string with_dimension(const char* name) {
  return name + std::to_string(D);
}

void bind_plc(py::module_& module);       // Plc, read_plc, file_dimension, resolve_crossings
void bind_mesh(py::module_& module);      // MeshData, read_mesh
void bind_fields(py::module_& module);    // Field, and what makes them
void bind_options(py::module_& module);   // Options, as refine and check take them
void bind_run(py::module_& module);       // StopSource, refine
void bind_check(py::module_& module);     // check, diagnose
void bind_estimate(py::module_& module);  // estimate
void bind_join(py::module_& module);      // join
void bind_periodic(py::module_& module);  // make_periodic, pair
void bind_remesh(py::module_& module);    // meshes as inputs, transfer of fields
void bind_surface(py::module_& module);   // replace_surface
void bind_page(py::module_& module);      // has_page, write_page

}  // namespace pgdr::python
