// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exceptions across the border: those of the library become the classes of pgdr/_errors.py, and an exception of Python passes
// through C++ as a PythonError.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>
#include <span>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::python {

namespace py = pybind11;

/// Deletes with the GIL, whoever does it.
struct GilDeleter {
  template <class T>
  void operator()(T* p) const {
    const py::gil_scoped_acquire gil;
    delete p;
  }
};

/// An exception that a callback of Python has raised: copied, kept and dropped by any thread, without the GIL.
class PythonError : public std::exception {
 public:
  /// Takes over what was raised. Has the GIL.
  explicit PythonError(py::error_already_set&& raised);
  const char* what() const noexcept override { return "a Python callback raised an exception"; }
  /// Raises it again. Has the GIL.
  void restore() const;

 private:
  std::shared_ptr<py::object> exception_;
};

/// A Diagnostic of pgdr/_errors.py.
py::object to_python(const Diagnostic& d);
/// A list of them.
py::list to_python(std::span<const Diagnostic> list);

/// From now on exceptions of the library leave functions of this module as those of Python.
void register_errors();

}  // namespace pgdr::python
