// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace learning::python {

/// Adds the class Rware: RWARE's warehouses, many at a time.
void defineRware(pybind11::module_& module);

}  // namespace learning::python
