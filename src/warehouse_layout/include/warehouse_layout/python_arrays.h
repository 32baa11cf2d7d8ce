// SPDX-License-Identifier: Apache-2.0
//
// Converts between numpy arrays and vectors, for the Python modules of this package and others.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <vector>

namespace layout::python {

namespace py = pybind11;

template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// Returns an array's elements, row by row; empty for None.
template <typename T>
std::vector<T> copied(const std::optional<Array<T>>& array) {
  if (!array) return {};
  return std::vector<T>(array->data(), array->data() + array->size());
}

/// Returns a vector as a new array.
template <typename T>
py::array_t<T> array(const std::vector<T>& vector) {
  return py::array_t<T>(static_cast<py::ssize_t>(vector.size()), vector.data());
}

/// Returns a vector as a read-only array that keeps its owner alive.
template <typename T>
py::array view(const std::vector<T>& vector, const py::object& owner,
               std::vector<py::ssize_t> shape = {}) {
  if (shape.empty()) shape = {static_cast<py::ssize_t>(vector.size())};
  py::array_t<T> array(shape, vector.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace layout::python
