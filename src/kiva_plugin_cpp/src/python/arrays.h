// SPDX-License-Identifier: Apache-2.0
//
// Converts between arrays of numpy and those of the world.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva::python {

namespace py = pybind11;

/// An argument that numpy converts to an array; signatures name it so.
class ArrayLike : public py::object {
 public:
  PYBIND11_OBJECT_DEFAULT(ArrayLike, py::object, isAny)
  static bool isAny(PyObject* /*object*/) { return true; }
};

/// Returns a read-only array over memory of the world, without a copy. The array holds the memory,
/// so that the last values outlive the world.
template <typename Out, typename T>
py::array_t<Out> view(const Column<T>& column, std::vector<py::ssize_t> shape = {}) {
  static_assert(sizeof(Out) == sizeof(T));
  if (shape.empty()) shape = {static_cast<py::ssize_t>(column.size())};
  py::object owner = py::none();
  if (column.data()) {
    ViewableMemory::hold(column.data());
    owner = py::capsule(column.data(), [](void* memory) { ViewableMemory::release(memory); });
  }
  py::array_t<Out> array(shape, reinterpret_cast<const Out*>(column.data()), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Returns a value as Python prints it.
inline std::string text(const py::object& value) { return py::str(value); }

/// An argument that is one number, or an array with one number a command. Throws TypeError unless
/// it holds such numbers and ValueError for an array of more than one dimension.
template <typename T>
class Numbers {
 public:
  Numbers(const char* name, const ArrayLike& value) : name_(name) {
    const py::array array = py::array::ensure(value);
    const char kind = array ? array.dtype().kind() : 'O';
    const bool fits = kind == 'i' || kind == 'u' || (kind == 'f' && std::is_floating_point_v<T>);
    if (!fits) {
      PyErr_Clear();
      throw py::type_error(std::string(name) + ": expected " +
                           (std::is_floating_point_v<T> ? "numbers" : "whole numbers") + ", not " +
                           (array ? text(array.dtype()) : text(py::type::of(value))));
    }
    if (array.ndim() > 1) {
      throw py::value_error(std::string(name) + ": expected a number or an array of shape (n,)," +
                            " not " + text(array.attr("shape")));
    }
    values_ = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(array);
    if constexpr (std::is_integral_v<T>) checkRange(array);
  }

  const char* name() const { return name_; }
  bool isOne() const { return values_.ndim() == 0 || values_.size() == 1; }
  py::ssize_t size() const { return values_.size(); }
  T operator[](py::ssize_t i) const { return values_.data()[isOne() ? 0 : i]; }
  const T* data() const { return values_.data(); }

 private:
  void checkRange(const py::array& array) const {
    const bool is_small = array.dtype().itemsize() < static_cast<py::ssize_t>(sizeof(T));
    if (is_small && (std::is_signed_v<T> || array.dtype().kind() == 'u')) return;
    const py::object same = values_.attr("__eq__")(array).attr("all")();
    if (!same.cast<bool>()) {
      throw py::value_error(std::string(name_) + ": a value is too large for 32 bits" +
                            (std::is_signed_v<T> ? "" : ", or negative"));
    }
  }

  const char* name_;
  py::array_t<T, py::array::c_style | py::array::forcecast> values_;
};

}  // namespace kiva::python

namespace pybind11::detail {

template <>
struct handle_type_name<kiva::python::ArrayLike> {
  static constexpr auto name = const_name("numpy.typing.ArrayLike");
};

}  // namespace pybind11::detail
