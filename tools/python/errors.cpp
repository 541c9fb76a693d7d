// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "errors.hpp"

#include <pybind11/stl.h>

#include <span>
#include <string>

namespace pgdr::python {
namespace {

const char* class_of(const Error& error) {
  if (dynamic_cast<const DiagnosedError*>(&error)) return "DiagnosedError";
  if (dynamic_cast<const InputError*>(&error)) return "InputError";
  if (dynamic_cast<const UsageError*>(&error)) return "UsageError";
  if (dynamic_cast<const FileError*>(&error)) return "FileError";
  if (dynamic_cast<const CancelledError*>(&error)) return "CancelledError";
  if (dynamic_cast<const ResourceError*>(&error)) return "ResourceError";
  return "Error";
}

void raise(const Error& error) {
  const py::object type = py::module_::import("pgdr._errors").attr(class_of(error));
  const auto* const input = dynamic_cast<const InputError*>(&error);
  const std::span<const Diagnostic> all = input ? std::span(input->diagnostics()) : std::span(&error.diagnostic(), 1);
  const py::object made = type.attr("_of")(to_python(error.diagnostic()), to_python(all));
  PyErr_SetObject(type.ptr(), made.ptr());
}

}  // namespace

PythonError::PythonError(py::error_already_set&& raised) : exception_(new py::object(raised.value()), GilDeleter{}) {
  if (raised.trace()) PyException_SetTraceback(exception_->ptr(), raised.trace().ptr());
}

void PythonError::restore() const { PyErr_SetObject(py::type::handle_of(*exception_).ptr(), exception_->ptr()); }

py::object to_python(const Diagnostic& d) {
  return py::module_::import("pgdr._errors")
      .attr("diagnostic")(std::string(name(d.code)), d.message, d.ids, d.points, d.file, d.line);
}

py::list to_python(std::span<const Diagnostic> list) {
  py::list made;
  for (const Diagnostic& d : list) made.append(to_python(d));
  return made;
}

void register_errors() {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const PythonError& e) {
      e.restore();
    } catch (const Error& e) {
      raise(e);
    }
  });
}

}  // namespace pgdr::python
