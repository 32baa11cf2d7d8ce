// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace fleet::python {

/// Execution, as the module's class of the same name.
void bindExecution(pybind11::module_& module);

}  // namespace fleet::python
