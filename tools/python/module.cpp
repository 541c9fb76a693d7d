// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr._pgdr: what pgdr/*.py is written on. No interface of its own: it trusts that its arguments have been checked there.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "errors.hpp"
#include "pgdr/version.hpp"
#include "words.hpp"

PYBIND11_MODULE(_pgdr, module) {
  module.doc() = "What the package pgdr is written on; not for its users.";
  module.attr("version") = PGDR_VERSION_STRING;
  module.attr("reason_codes") = pybind11::cast(pgdr::tool::code_names);
  module.attr("entity_kinds") = pybind11::cast(pgdr::tool::kind_names);
  pgdr::python::register_errors();
  pgdr::python::bind_plc(module);
  pgdr::python::bind_fields(module);
  pgdr::python::bind_mesh(module);
  pgdr::python::bind_options(module);
  pgdr::python::bind_run(module);
  pgdr::python::bind_check(module);
  pgdr::python::bind_estimate(module);
  pgdr::python::bind_join(module);
  pgdr::python::bind_periodic(module);
  pgdr::python::bind_surface(module);
  pgdr::python::bind_page(module);
  pgdr::python::bind_remesh(module);
}
