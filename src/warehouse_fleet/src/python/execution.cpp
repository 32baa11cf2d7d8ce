// SPDX-License-Identifier: Apache-2.0
#include "execution.h"

#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "arrays.h"
#include "warehouse_fleet/execution.h"

namespace fleet::python {
namespace {

/// Execution, and the floor that it is about.
struct Run {
  std::shared_ptr<Floor> floor;
  Execution execution;
};

using Numbers = Array<double>;
using Bytes = Array<std::uint8_t>;
using Counts = Array<std::uint32_t>;

template <typename T>
const T* column(const Array<T>& array, py::ssize_t robots, const char* name) {
  if (array.size() == robots) return array.data();
  throw py::value_error(std::string(name) + " has " + std::to_string(array.size()) +
                        " elements; one a robot, " + std::to_string(robots) + ", was expected");
}

void observe(Run& run, double time, const Numbers& x, const Numbers& y, const Numbers& yaw,
             const Numbers& vx, const Numbers& vy, const Bytes& status, const Bytes& state,
             const Counts& path_id, const Counts& reached, const Counts& left,
             const Bytes& controlled, const Bytes& busy, const Bytes& loaded) {
  std::vector<Report> reports(x.size());
  const auto fill = [&](const auto& array, const char* name, auto member) {
    const auto* data = column(array, x.size(), name);
    for (std::size_t i = 0; i < reports.size(); ++i) reports[i].*member = data[i];
  };
  fill(x, "x", &Report::x);
  fill(y, "y", &Report::y);
  fill(yaw, "yaw", &Report::yaw);
  fill(vx, "vx", &Report::vx);
  fill(vy, "vy", &Report::vy);
  fill(status, "status", &Report::status);
  fill(state, "state", &Report::state);
  fill(path_id, "path_id", &Report::path_id);
  fill(reached, "reached", &Report::reached);
  fill(left, "left", &Report::left);
  fill(controlled, "controlled", &Report::is_controlled);
  fill(busy, "busy", &Report::is_busy);
  fill(loaded, "loaded", &Report::is_loaded);
  run.execution.observe(time, reports);
}

template <typename T>
py::array_t<T> array(const std::vector<T>& vector) {
  return py::array_t<T>(static_cast<py::ssize_t>(vector.size()), vector.data());
}

py::tuple release(Run& run) {
  const Releases releases = run.execution.release();
  return py::make_tuple(array(releases.robot), array(releases.path_id), array(releases.first),
                        array(releases.points), array(releases.cells), array(releases.released));
}

/// One of the questions about a robot, for all of them.
template <typename T, typename Question>
auto ofAll(Question question) {
  return [question](const Run& run) {
    py::array_t<T> answers(run.execution.robots());
    for (int robot = 0; robot < run.execution.robots(); ++robot) {
      answers.mutable_at(robot) = static_cast<T>((run.execution.*question)(robot));
    }
    return answers;
  };
}

std::unique_ptr<Run> make(std::shared_ptr<Floor> floor, const std::pair<double, double>& origin,
                          double spacing, double speed, double acceleration, double quarter,
                          double latency) {
  const Motion motion{origin.first, origin.second, spacing, speed, acceleration, quarter, latency};
  return std::make_unique<Run>(Run{floor, Execution(*floor, motion)});
}

}  // namespace

void bindExecution(py::module_& module) {
  const Motion usual;
  py::class_<Run>(module, "Execution")
      .def(py::init(&make), py::arg("floor"), py::arg("origin") = std::pair(0.0, 0.0),
           py::arg("spacing") = usual.spacing, py::arg("speed") = usual.speed,
           py::arg("acceleration") = usual.acceleration, py::arg("quarter") = usual.quarter,
           py::arg("latency") = usual.latency)
      .def("observe", &observe, py::arg("time"), py::arg("x"), py::arg("y"), py::arg("yaw"),
           py::arg("vx"), py::arg("vy"), py::arg("status"), py::arg("state"), py::arg("path_id"),
           py::arg("reached"), py::arg("left"), py::arg("controlled"), py::arg("busy"),
           py::arg("loaded"))
      .def(
          "set_work",
          [](Run& run, const Bytes& busy, const Bytes& loaded) {
            run.execution.setWork({busy.data(), busy.data() + busy.size()},
                                  {loaded.data(), loaded.data() + loaded.size()});
          },
          py::arg("busy"), py::arg("loaded"))
      .def("set_broken",
           [](Run& run, const Bytes& broken) {
             run.execution.setBroken({broken.data(), broken.data() + broken.size()});
           })
      .def(
          "fleet",
          [](Run& run, const Array<Cell>& goal, const Array<Cell>& home, int horizon) {
            const std::vector<Cell> goals(goal.data(), goal.data() + goal.size());
            const std::vector<Cell> homes(home.data(), home.data() + home.size());
            return run.execution.fleet(goals, homes, horizon);
          },
          py::arg("goal"), py::arg("home"), py::arg("horizon"))
      .def("adopt", [](Run& run, const Bytes& actions) { run.execution.adopt(makePlan(actions)); })
      .def("release", &release)
      .def("refused", [](Run& run, int robot) { run.execution.refused(robot); })
      .def("close", [](Run& run, Cell cell, double until) { run.execution.close(cell, until); })
      .def("recall", [](Run& run, Cell cell) { run.execution.recall(cell); })
      .def("set_units",
           [](Run& run, const Array<Cell>& cells) {
             run.execution.setUnits({cells.data(), cells.data() + cells.size()});
           })
      .def("set_zone",
           [](Run& run, const Array<Cell>& cells) {
             run.execution.setZone({cells.data(), cells.data() + cells.size()});
           })
      .def_property_readonly("closing", [](const Run& run) { return run.execution.isClosing(); })
      .def("closed", [](const Run& run) { return array(run.execution.closed()); })
      .def("cell", ofAll<Cell>(&Execution::cellOf))
      .def("stands", ofAll<bool>(&Execution::stands))
      .def("waits_for", ofAll<int>(&Execution::waitsFor))
      .def("foreign", ofAll<bool>(&Execution::isForeign))
      .def("stalled", ofAll<bool>(&Execution::isStalled))
      .def("astray", ofAll<bool>(&Execution::isAstray))
      .def("lost", ofAll<bool>(&Execution::isLost))
      .def("still_since", ofAll<double>(&Execution::stillSince))
      .def("holder", [](const Run& run, Cell cell) { return run.execution.holder(cell); })
      .def("released", [](const Run& run, int robot) { return run.execution.released(robot); })
      .def("planned", [](const Run& run, int robot) { return run.execution.planned(robot); })
      .def("take_journey",
           [](Run& run, int robot) {
             const Journey journey = run.execution.takeJourney(robot);
             return py::make_tuple(journey.driven, journey.planned, journey.cells);
           })
      .def_property_readonly("blocked", [](const Run& run) { return run.execution.blocked(); });
}

}  // namespace fleet::python
