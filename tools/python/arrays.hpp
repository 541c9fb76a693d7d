// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Arrays of numpy as spans and vectors of C++, and back. What is called here has the GIL. The Python side (pgdr/_arguments.py)
// has checked shapes and types, and has made arrays contiguous; what is asked here again guards memory, not manners.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/types.hpp"

namespace pgdr::python {

namespace py = pybind11;

/// A contiguous array of just this type: what is not is refused, and nothing is converted.
template <class T>
using Dense = py::array_t<T, py::array::c_style>;

template <class T>
std::span<const T> span_of(const Dense<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

[[noreturn]] inline void bad_argument(std::string_view what) {
  throw UsageError({.code = Errc::bad_option, .message = std::string(what)});
}

[[noreturn]] inline void bad_input(Errc code, const std::string& message, const std::vector<std::int64_t>& ids) {
  throw InputError({.code = code, .message = message, .ids = ids});
}

/// @throws InputError not_finite, with the number of the first that is not
template <int D>
void require_finite(const std::vector<Point<D>>& points, const char* what) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::ranges::all_of(points[i].x, [](double x) { return std::isfinite(x); }))
      bad_input(Errc::not_finite, std::string(what) + ' ' + std::to_string(i) + " has a coordinate that is not finite",
                {static_cast<std::int64_t>(i)});
}

/// The numbers of a contiguous array of float64 or float32.
CoordinateArray coordinates_of(const py::array& array);
/// The numbers of a contiguous array of integers of 32 or 64 bits.
IndexArray indices_of(const py::array& array);

template <int D>
std::vector<Point<D>> points_of(const Dense<double>& array) {
  const auto numbers = span_of(array);
  if (numbers.size() % D != 0) bad_argument("coordinates are no multiple of the dimension");
  std::vector<Point<D>> points(numbers.size() / D);
  if (!points.empty()) std::memcpy(points.front().x.data(), numbers.data(), numbers.size_bytes());
  return points;
}

template <class T>
std::vector<T> vector_of(const Dense<T>& array) {
  const auto numbers = span_of(array);
  return {numbers.begin(), numbers.end()};
}

using Shape = std::vector<py::ssize_t>;

/// An array that reads the memory of `owner`, which it keeps alive. `strides` in bytes; empty: one after the other.
template <class T>
py::array view(py::handle owner, const T* data, Shape shape, Shape strides = {}) {
  static const T nothing{};  // an array without elements reads none, but numpy would take null for a wish to allocate
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), data ? data : &nothing, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// An array that takes over a vector. Read-only, as all results are.
template <class T>
py::array own(std::vector<T>&& numbers, Shape shape) {
  auto* const kept = new std::vector<T>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return view(owner, kept->data(), std::move(shape));
}
/// The same of rows of N numbers.
template <class T, std::size_t N>
py::array own(std::vector<std::array<T, N>>&& rows) {
  const auto count = static_cast<py::ssize_t>(rows.size());
  auto* const kept = new std::vector<std::array<T, N>>(std::move(rows));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<std::array<T, N>>*>(p); });
  return view(owner, kept->empty() ? nullptr : kept->front().data(), {count, static_cast<py::ssize_t>(N)});
}
template <class T>
py::array own(std::vector<T>&& numbers) {
  const auto count = static_cast<py::ssize_t>(numbers.size());
  return own(std::move(numbers), {count});
}

/// Points as an (n, D) array that reads them in place.
template <int D>
py::array view_points(py::handle owner, std::span<const Point<D>> points) {
  return view(owner, flat<D>(points).data(), {static_cast<py::ssize_t>(points.size()), D});
}

/// A member of each struct of a vector, as an array of one number a struct, or, of a member that is an array of N numbers, N.
template <class T, class Struct>
py::array view_member(py::handle owner, const std::vector<Struct>& structs, T Struct::*member) {
  const auto count = static_cast<py::ssize_t>(structs.size());
  return view<T>(owner, structs.empty() ? nullptr : &(structs.front().*member), {count}, {sizeof(Struct)});
}
template <class T, std::size_t N, class Struct>
py::array view_member(py::handle owner, const std::vector<Struct>& structs, std::array<T, N> Struct::*member) {
  const auto count = static_cast<py::ssize_t>(structs.size());
  return view<T>(owner, structs.empty() ? nullptr : (structs.front().*member).data(), {count, N}, {sizeof(Struct), sizeof(T)});
}

}  // namespace pgdr::python
