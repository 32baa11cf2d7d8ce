// SPDX-License-Identifier: Apache-2.0
//
// Conversions between numpy arrays and the planner's types.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>

#include "warehouse_fleet/fleet.h"
#include "warehouse_layout/python_arrays.h"

namespace py = pybind11;

namespace fleet::python {

using layout::python::array;
using layout::python::Array;
using layout::python::copied;
using layout::python::view;

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
