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

/// Returns an array without a conversion. Throws ValueError, which names the argument, for another
/// type or shape.
template <typename T>
Array<T> checked(const char* name, const py::object& argument, std::vector<py::ssize_t> shape) {
  bool fits = py::isinstance<Array<T>>(argument);
  if (fits) {
    const auto array = py::reinterpret_borrow<py::array>(argument);
    fits = std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) == shape;
  }
  if (!fits) {
    throw py::value_error(std::string(name) + ": expected an array of " + text(py::dtype::of<T>()) +
                          ", contiguous, of shape " + text(py::tuple(py::cast(shape))));
  }
  return py::reinterpret_borrow<Array<T>>(argument);
}

}  // namespace learning::python
