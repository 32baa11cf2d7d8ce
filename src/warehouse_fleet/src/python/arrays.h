// SPDX-License-Identifier: Apache-2.0
//
// Between arrays of numpy and what the planner is written in.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace py = pybind11;

namespace fleet::python {

template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <typename T>
std::vector<T> copied(const std::optional<Array<T>>& array) {
  if (!array) return {};
  return std::vector<T>(array->data(), array->data() + array->size());
}

/// A vector of C++ as an array that can be read and lives as long as its owner.
template <typename T>
py::array view(const std::vector<T>& vector, const py::object& owner,
               std::vector<py::ssize_t> shape = {}) {
  if (shape.empty()) shape = {static_cast<py::ssize_t>(vector.size())};
  py::array_t<T> array(shape, vector.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

inline Plan makePlan(const Array<std::uint8_t>& actions) {
  if (actions.ndim() != 2) throw py::value_error("actions must be (robots, ticks)");
  Plan plan;
  plan.horizon = static_cast<int>(actions.shape(1));
  for (py::ssize_t i = 0; i < actions.size(); ++i) {
    if (actions.data()[i] > 3) {
      throw py::value_error("action " + std::to_string(actions.data()[i]) +
                            "; 0 (wait), 1 (forward), 2 or 3 (turn) was expected");
    }
    plan.actions.push_back(static_cast<Action>(actions.data()[i]));
  }
  return plan;
}

}  // namespace fleet::python
