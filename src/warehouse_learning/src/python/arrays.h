// SPDX-License-Identifier: Apache-2.0
//
// numpy arrays as arguments.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

namespace learning::python {

namespace py = pybind11;

template <typename T>
using Array = py::array_t<T, py::array::c_style>;

inline std::string text(const py::object& value) { return py::str(value); }

/// Nothing is converted: another type or shape is a ValueError that names the argument.
template <typename T>
Array<T> checked(const char* name, const py::object& given, std::vector<py::ssize_t> shape) {
  bool fits = py::isinstance<Array<T>>(given);
  if (fits) {
    const auto array = py::reinterpret_borrow<py::array>(given);
    fits = std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) == shape;
  }
  if (!fits) {
    throw py::value_error(std::string(name) + ": expected an array of " + text(py::dtype::of<T>()) +
                          ", contiguous, of shape " + text(py::tuple(py::cast(shape))));
  }
  return py::reinterpret_borrow<Array<T>>(given);
}

}  // namespace learning::python
