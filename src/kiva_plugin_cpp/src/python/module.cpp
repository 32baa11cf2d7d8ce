// SPDX-License-Identifier: Apache-2.0
//
// The world inside a Python process. The files of this folder translate between C++ and Python;
// python/kiva_plugin_cpp/__init__.py adds methods that are easier to write in Python.
#include <pybind11/stl.h>

#include "host.h"

namespace kiva::python {

PYBIND11_MODULE(_core, m) {
  PYBIND11_NUMPY_DTYPE(Command, kind, kiva_id, x, y, direction, lift, shelf_id);
  py::register_exception<DescriptionError>(m, "DescriptionError", PyExc_ValueError);
  py::register_exception<CheckpointError>(m, "CheckpointError", PyExc_ValueError);
  m.attr("COMMAND") = py::dtype::of<Command>();
  m.def("environment_model_paths", &environmentModelPaths);
  m.def("model_paths_around", &modelPathsAround, py::arg("world_file"));
  defineFleet(m);
  defineWorld(m);
  defineWorlds(m);
}

}  // namespace kiva::python
