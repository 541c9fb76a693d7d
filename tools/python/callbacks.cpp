// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "callbacks.hpp"

#include <cstring>
#include <memory>
#include <span>
#include <string>

#include "arrays.hpp"
#include "thread_gil.hpp"

namespace pgdr::python {
namespace {

/// A function of Python that any thread may copy and drop.
class SharedFunction {
 public:
  explicit SharedFunction(py::function f) : f_(new py::function(std::move(f)), GilDeleter{}) {}
  ThreadGil::Callers& callers() const { return *callers_; }  ///< of it
  /// Calls it, and hands its result to `read`. What either raises leaves as a PythonError. Has the GIL.
  template <class Read, class... Arguments>
  void operator()(const Read& read, Arguments&&... arguments) const {
    try {
      read((*f_)(std::forward<Arguments>(arguments)...));
    } catch (py::error_already_set& raised) {
      throw PythonError(std::move(raised));
    }
  }

 private:
  std::shared_ptr<py::function> f_;
  std::shared_ptr<ThreadGil::Callers> callers_ = std::make_shared<ThreadGil::Callers>(0);
};

std::string shape_words(const py::array& array) {
  std::string words = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) words += (i ? ", " : "") + std::to_string(array.shape(i));
  return words + (array.ndim() == 1 ? ",)" : ")");
}

/// The numbers that a callback has returned, one after the other. `or_else`: words for what else it may return.
/// @throws UsageError
void take_numbers(const py::object& returned, const Shape& shape, const char* who, std::span<double> numbers,
                  const char* or_else = "") {
  const auto refuse = [&](const std::string& what) {
    py::array wanted(py::dtype::of<char>(), shape);
    throw UsageError(
        {.code = Errc::bad_option,
         .message = std::string(who) + " must return numbers of shape " + shape_words(wanted) + or_else + ", not " + what});
  };
  const auto has_shape = [&](const py::array& a) {
    return a.ndim() == static_cast<py::ssize_t>(shape.size()) && std::equal(shape.begin(), shape.end(), a.shape());
  };
  if (Dense<double>::check_(returned)) {  // nearly always
    const auto dense = py::reinterpret_borrow<Dense<double>>(returned);
    if (has_shape(dense)) return static_cast<void>(std::memcpy(numbers.data(), dense.data(), numbers.size_bytes()));
  }
  if (returned.is_none()) refuse("None");
  const py::array array = py::array::ensure(returned);
  if (!array) refuse("an object of the type " + std::string(py::str(py::type::of(returned).attr("__name__"))));
  if (std::string_view("fiu").find(array.dtype().kind()) == std::string_view::npos)
    refuse("an array of the type " + std::string(py::str(array.dtype())));
  if (!has_shape(array)) refuse("an array of shape " + shape_words(array));
  const auto dense = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!dense) refuse("an array of the type " + std::string(py::str(array.dtype())));
  std::memcpy(numbers.data(), dense.data(), numbers.size_bytes());
}

template <int D>
void ask_sizes(const SharedFunction& f, std::span<const Point<D>> points, std::span<double> sizes) {
  const ThreadGil gil(f.callers());
  const auto count = static_cast<py::ssize_t>(points.size());
  py::array_t<double> array({count, static_cast<py::ssize_t>(D)});
  std::memcpy(array.mutable_data(), points.data(), points.size_bytes());
  f([&](const py::object& returned) { take_numbers(returned, {count}, "the size function", sizes); }, std::move(array));
}

/// One array of a value of each element.
template <std::size_t N, int D, class Get>
py::array_t<double> gather(std::span<const PoorElement<D>> elements, Shape shape, const Get& get) {
  shape.insert(shape.begin(), static_cast<py::ssize_t>(elements.size()));
  py::array_t<double> array(shape);
  double* to = array.mutable_data();
  for (const PoorElement<D>& e : elements) {
    const auto& value = get(e);
    static_assert(sizeof value == N * sizeof(double));
    std::memcpy(to, &value, sizeof value);
    to += N;
  }
  return array;
}

/// The points that a selector has returned: an array of n points, or of n times k, where rows of NaN behind the first are none.
/// @throws UsageError
template <int D>
void take_points(const py::object& returned, std::span<SelectedPoints<D>> points) {
  constexpr auto most = static_cast<py::ssize_t>(SelectedPoints<D>::most);
  const auto count = static_cast<py::ssize_t>(points.size());
  Shape shape{count, D};
  std::size_t each = 1;
  if (py::isinstance<py::array>(returned) || py::isinstance<py::sequence>(returned)) {
    const py::array array = py::array::ensure(returned);
    if (array && array.ndim() == 3 && array.shape(1) >= 1 && array.shape(1) <= most) {
      each = static_cast<std::size_t>(array.shape(1));
      shape = {count, array.shape(1), D};
    }
  }
  std::vector<Point<D>> all(points.size() * each);
  take_numbers(returned, shape, "the selector", {all.front().x.data(), all.size() * D},
               each == 1 ? ", or as many times k points, k up to 8" : "");
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % each == 0 || all[i] == all[i]) points[i / each].push_back(all[i]);
}

template <int D>
void ask_points(const SharedFunction& f, const py::object& type, std::span<const PoorElement<D>> elements,
                std::span<SelectedPoints<D>> points) {
  const ThreadGil gil(f.callers());
  using Element = PoorElement<D>;
  py::array_t<bool> over(static_cast<py::ssize_t>(elements.size()));
  for (std::size_t i = 0; i < elements.size(); ++i) over.mutable_data()[i] = elements[i].over_radius_edge;
  const py::object asked = type(gather<(D + 1) * D>(
                                    elements, {D + 1, D}, [](const Element& e) -> const auto& { return e.corners; }),
                                gather<D>(
                                    elements, {D}, [](const Element& e) -> const auto& { return e.circumcenter; }),
                                gather<1>(
                                    elements, {}, [](const Element& e) -> const auto& { return e.circumradius; }),
                                gather<1>(
                                    elements, {}, [](const Element& e) -> const auto& { return e.shortest_edge; }),
                                gather<D>(
                                    elements, {D}, [](const Element& e) -> const auto& { return e.disk.center; }),
                                gather<1>(
                                    elements, {}, [](const Element& e) -> const auto& { return e.disk.radius; }),
                                over);
  f([&](const py::object& returned) { take_points<D>(returned, points); }, asked);
}

}  // namespace

template <int D>
SizingField<D> sizes_by(py::function f) {
  return SizingField<D>::by_blocks([f = SharedFunction(std::move(f))](std::span<const Point<D>> points, std::span<double> sizes) {
    ask_sizes<D>(f, points, sizes);
  });
}

template <int D>
PointSelector<D> selector_by(py::function f) {
  const std::shared_ptr<py::object> type(new py::object(py::module_::import("pgdr._run").attr("Elements")), GilDeleter{});
  return PointSelector<D>::by_blocks_of_several(
      [f = SharedFunction(std::move(f)), type](std::span<const PoorElement<D>> elements, std::span<SelectedPoints<D>> points) {
        ask_points<D>(f, *type, elements, points);
      });
}

template SizingField<2> sizes_by<2>(py::function);
template SizingField<3> sizes_by<3>(py::function);
template PointSelector<2> selector_by<2>(py::function);
template PointSelector<3> selector_by<3>(py::function);

}  // namespace pgdr::python
