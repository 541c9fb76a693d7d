// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr._pgdr: what pgdr/*.py is written on. No interface of its own: it trusts that its arguments have been checked there.
#include <pybind11/pybind11.h>

#include "bind.hpp"
#include "errors.hpp"
#include "pgdr/version.hpp"

PYBIND11_MODULE(_pgdr, module) {
  module.doc() = "What the package pgdr is written on; not for its users.";
  module.attr("version") = PGDR_VERSION_STRING;
  pgdr::python::register_errors();
  pgdr::python::bind_plc(module);
  pgdr::python::bind_fields(module);
  pgdr::python::bind_mesh(module);
  pgdr::python::bind_options(module);
  pgdr::python::bind_run(module);
  pgdr::python::bind_check(module);
}
