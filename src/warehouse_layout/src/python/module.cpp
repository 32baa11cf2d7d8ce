// SPDX-License-Identifier: Apache-2.0
//
// The floor and its check inside a Python process. This file translates; python/warehouse_layout
// adds what is easier to write in Python.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "warehouse_layout/layout_check.h"
#include "warehouse_layout/python_arrays.h"
#include "warehouse_layout/routes.h"

namespace layout::python {
namespace {

using Flags = std::optional<Array<std::uint8_t>>;

std::shared_ptr<Floor> makeFloor(const Array<std::uint8_t>& passable, const Flags& storage,
                                 const Flags& lane, const Flags& exits, const Flags& parking) {
  if (passable.ndim() != 2) throw py::value_error("passable must have two dimensions, (y, x)");
  FloorDescription description;
  description.height = static_cast<int>(passable.shape(0));
  description.width = static_cast<int>(passable.shape(1));
  description.passable = copied<std::uint8_t>(passable);
  description.storage = copied(storage);
  description.parking = copied(parking);
  description.lane = copied(lane);
  description.exits = copied(exits);
  return std::make_shared<Floor>(description);
}

void bindFloor(py::module_& module) {
  py::class_<Floor, std::shared_ptr<Floor>>(module, "Floor")
      .def(py::init(&makeFloor), py::arg("passable"), py::arg("storage") = py::none(),
           py::arg("lane") = py::none(), py::arg("exits") = py::none(),
           py::arg("parking") = py::none())
      .def_property_readonly("width", &Floor::width)
      .def_property_readonly("height", &Floor::height)
      .def_property_readonly("size", &Floor::size)
      .def("name", &Floor::name)
      .def(
          "is_lane",
          [](const Floor& floor, Cell cell) { return floor.has(cell) && floor.isLane(cell); },
          py::arg("cell"), "Returns whether a cell is of a station's one-way lane.")
      .def(
          "shortest",
          [](const Floor& floor, Cell begin, Cell end, bool loaded) {
            if (!floor.has(begin) || !floor.has(end)) throw FloorError("a cell off the floor");
            return shortest(floor, loaded ? Deck::kAisles : Deck::kUnder, begin, end);
          },
          py::arg("begin"), py::arg("end"), py::arg("loaded") = false)
      .def(
          "edges",
          [](const py::object& self, bool loaded) {
            const auto& floor = self.cast<const Floor&>();
            return view(floor.edges(loaded ? Deck::kAisles : Deck::kUnder), self,
                        {floor.size(), kHeadings});
          },
          py::arg("loaded") = false);
}

RouteGraph makeGraph(const Array<Cell>& next, const Array<std::uint8_t>& end, Cell start,
                     double step, double turn) {
  const auto cells = static_cast<Cell>(end.size());
  if (next.size() != end.size() * kHeadings || start < 0 || start >= cells) {
    throw py::value_error("next (cells, 4), end (cells,) and a cell as start were expected");
  }
  return {next.data(), end.data(), cells, step, turn};
}

py::tuple makeWays(const Array<Cell>& next, const Array<std::uint8_t>& end, Cell start, double step,
                   double turn, const Array<Cell>& to) {
  const RouteGraph graph = makeGraph(next, end, start, step, turn);
  const std::vector<Cell> ends = copied<Cell>(to);
  for (const Cell cell : ends) {
    if (cell < 0 || cell >= graph.cells) throw py::value_error("to holds what is not a cell");
  }
  Ways ways;
  {
    py::gil_scoped_release others_may_run;
    ways = waysFrom(graph, start, ends);
  }
  return py::make_tuple(array(ways.seconds), array(ways.steps));
}

py::tuple makeRoutes(const Array<Cell>& next, const Array<std::uint8_t>& end, Cell start,
                     double step, double turn) {
  const RouteGraph graph = makeGraph(next, end, start, step, turn);
  Routes routes;
  {
    py::gil_scoped_release others_may_run;
    routes = routesFrom(graph, start);
  }
  return py::make_tuple(array(routes.seconds), array(routes.steps), array(routes.before));
}

void bindRoutes(py::module_& module) {
  module.def("routes", &makeRoutes, py::arg("next"), py::arg("end"), py::arg("start"),
             py::arg("step"), py::arg("turn"),
             R"(Returns the quickest ways from a cell to all others, which begin in any heading.

next: (cells, 4) int32, the cell beside each in each heading, or -1. end: (cells,), where ways end.
step, turn: from a cell to the next, and by a quarter [s]. Returns (seconds, steps, before), each
(4 * cells,) by cell * 4 + heading: infinite where none comes by, how many cells, the one before.)");
  module.def(
      "ways", &makeWays, py::arg("next"), py::arg("end"), py::arg("start"), py::arg("step"),
      py::arg("turn"), py::arg("to"),
      R"(Returns the same to the cells `to`, (n,), alone, each in the heading that is reached first.

Returns (seconds, steps), (n,) each.)");
}

void bindLayout(py::module_& module) {
  module.def(
      "check_layout",
      [](const Floor& floor, double x, double y, double spacing) {
        std::vector<std::string> texts;
        for (const LayoutFault& fault : checkLayout(floor)) {
          texts.push_back(describe(fault, floor, {x, y, spacing}));
        }
        return texts;
      },
      py::arg("floor"), py::arg("x") = 0.0, py::arg("y") = 0.0, py::arg("spacing") = 1.0);
}

void bindLayoutFaults(py::module_& module) {
  module.def(
      "layout_faults",
      [](const Floor& floor) {
        std::vector<std::pair<std::string, std::vector<Cell>>> faults;
        for (const LayoutFault& fault : checkLayout(floor)) {
          const bool is_dead_end = fault.kind == LayoutFault::Kind::kDeadEnd;
          faults.emplace_back(is_dead_end ? "dead end" : "cut off", fault.cells);
        }
        return faults;
      },
      py::arg("floor"));
}

}  // namespace
}  // namespace layout::python

PYBIND11_MODULE(_core, module) {
  using namespace layout::python;
  py::register_exception<layout::FloorError>(module, "FloorError", PyExc_ValueError);
  bindFloor(module);
  bindRoutes(module);
  bindLayout(module);
  bindLayoutFaults(module);
}
