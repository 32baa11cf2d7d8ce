// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace fleet::python {

/// Defines the class Execution of the module.
void bindExecution(pybind11::module_& module);

}  // namespace fleet::python
