// SPDX-License-Identifier: Apache-2.0
#include "execution.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <type_traits>
#include <utility>

#include "arrays.h"
#include "warehouse_fleet/execution.h"

namespace fleet::python {
namespace {

/// Execution, and its floor.
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

void update(Run& run, double time, const Numbers& x, const Numbers& y, const Numbers& yaw,
            const Numbers& vx, const Numbers& vy, const Bytes& status, const Bytes& state,
            const Counts& path_id, const Counts& reached, const Counts& left,
            const Bytes& controlled, const Bytes& busy, const Bytes& loaded) {
  std::vector<Report> reports(x.size());
  const auto fill = [&](const auto& array, const char* name, auto member) {
    const auto* data = column(array, x.size(), name);
    for (std::size_t i = 0; i < reports.size(); ++i) {
      auto& value = reports[i].*member;
      value = static_cast<std::decay_t<decltype(value)>>(data[i]);
    }
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
  run.execution.update(time, std::move(reports));
}

py::tuple release(Run& run) {
  const Releases releases = run.execution.release();
  return py::make_tuple(array(releases.robot), array(releases.path_id), array(releases.first),
                        array(releases.points), array(releases.cells), array(releases.released));
}

void drive(Run& run, const Array<int>& steps, const Array<Cell>& cell, const Array<int>& tick) {
  column(steps, run.execution.robots(), "steps");
  std::vector<std::deque<Step>> plans(steps.size());
  py::ssize_t next = 0;
  for (std::size_t robot = 0; robot < plans.size(); ++robot) {
    const py::ssize_t end = next + steps.data()[robot];
    if (end > std::min(cell.size(), tick.size())) break;
    for (; next < end; ++next) plans[robot].push_back({cell.data()[next], tick.data()[next]});
  }
  if (next != cell.size() || next != tick.size()) {
    throw py::value_error("steps, cell and tick differ in length");
  }
  run.execution.drive(std::move(plans));
}

/// Returns the answers of one query for all robots.
template <typename T, typename Question>
auto ofAll(Question question) {
  return [question](const Run& run) {
    py::array_t<T> answers(run.execution.robots());
    T* answer = answers.mutable_data();
    for (int robot = 0; robot < run.execution.robots(); ++robot) {
      *answer++ = static_cast<T>((run.execution.*question)(robot));
    }
    return answers;
  };
}

/// Returns the states of all robots in one pass: courses of a large fleet don't fit into a cache.
py::tuple states(const Run& run) {
  const Execution& execution = run.execution;
  const int robots = execution.robots();
  py::array_t<Cell> cell(robots);
  py::array_t<double> still_since(robots);
  py::array_t<bool> stands(robots), stalled(robots), astray(robots), lost(robots);
  py::array_t<bool> foreign(robots), dropped(robots);
  for (int robot = 0; robot < robots; ++robot) {
    cell.mutable_data()[robot] = execution.cellOf(robot);
    stands.mutable_data()[robot] = execution.stands(robot);
    stalled.mutable_data()[robot] = execution.isStalled(robot);
    astray.mutable_data()[robot] = execution.isAstray(robot);
    lost.mutable_data()[robot] = execution.isLost(robot);
    still_since.mutable_data()[robot] = execution.stillSince(robot);
    foreign.mutable_data()[robot] = execution.isForeign(robot);
    dropped.mutable_data()[robot] = execution.isOnDroppedPath(robot);
  }
  return py::make_tuple(cell, stands, stalled, astray, lost, still_since, foreign, dropped);
}

std::unique_ptr<Run> make(const std::shared_ptr<Floor>& floor,
                          const std::pair<double, double>& origin, double spacing, double speed,
                          double acceleration, double quarter, double latency) {
  const Motion motion{origin.first, origin.second, spacing, speed, acceleration, quarter, latency};
  return std::make_unique<Run>(Run{floor, Execution(*floor, motion)});
}

}  // namespace

void bindExecution(py::module_& module) {
  const Motion usual;
  py::class_<Run>(module, "Execution", R"(Drives a fleet by plans, cell by cell.

Cells are indices into the floor, robots indices into the arrays of update(); -1 stands for no cell
and for no robot. IndexError for a robot that does not exist.)")
      .def(py::init(&make), py::arg("floor"), py::arg("origin") = std::pair(0.0, 0.0),
           py::arg("spacing") = usual.spacing, py::arg("speed") = usual.speed,
           py::arg("acceleration") = usual.acceleration, py::arg("quarter") = usual.quarter,
           py::arg("latency") = usual.latency,
           R"(Prepares the drive of a fleet that update() brings in.

floor: the cells that robots drive on. origin: the centre of cell 0 in world [m]. spacing: between
centres of cells [m]. speed [m/s], acceleration [m/s²]: the robots' limits. quarter: duration of a
quarter turn [s]. latency: from a report until a command that it causes has reached the robot [s].)")
      .def("update", &update, py::arg("time"), py::arg("x"), py::arg("y"), py::arg("yaw"),
           py::arg("vx"), py::arg("vy"), py::arg("status"), py::arg("state"), py::arg("path_id"),
           py::arg("reached"), py::arg("left"), py::arg("controlled"), py::arg("busy"),
           py::arg("loaded"),
           R"(Updates all robots by their reports, and frees the cells that they left.

time [s]. All others are arrays (n,), an element for each robot, named as in FleetState: x, y [m],
yaw [rad] and vx, vy [m/s] in the frame world; status, state (KivaStatus); path_id, reached, left.
controlled: the fleet commands the robot, else it is an obstacle. busy: it does something other than
driving, and is not sent on. loaded: it carries a unit. Starts from the robots' places at the first
call and whenever n changes. ValueError if the arrays differ in length.)")
      .def(
          "set_work",
          [](Run& run, const Bytes& busy, const Bytes& loaded) {
            run.execution.setWork({busy.data(), busy.data() + busy.size()},
                                  {loaded.data(), loaded.data() + loaded.size()});
          },
          py::arg("busy"), py::arg("loaded"),
          "Sets which robots are busy and loaded, (n,) bool each, where that changed since the "
          "reports.")
      .def(
          "set_broken",
          [](Run& run, const Bytes& broken) {
            run.execution.setBroken({broken.data(), broken.data() + broken.size()});
          },
          py::arg("broken"),
          "Sets which robots are broken, (n,) bool: others are routed around them at once.")
      .def(
          "fleet",
          [](Run& run, const Array<Cell>& goal, const Array<Cell>& home, int horizon) {
            const std::vector<Cell> goals(goal.data(), goal.data() + goal.size());
            const std::vector<Cell> homes(home.data(), home.data() + home.size());
            return run.execution.fleet(goals, homes, horizon);
          },
          py::arg("goal"), py::arg("home"), py::arg("horizon"),
          R"(Returns the Fleet for the planner: where robots are, and what is committed already.

goal, home: (n,) int32 cells. horizon: ticks. Robots that are not controlled are closed cells.)")
      .def(
          "adopt", [](Run& run, const Bytes& actions) { run.execution.adopt(makePlan(actions)); },
          py::arg("actions"),
          R"(Has robots drive by a plan for the Fleet that fleet() returned last.

actions: (n, horizon) uint8 of Action. A robot that was released other cells since then keeps to
them until the next plan.)")
      .def("drive", &drive, py::arg("steps"), py::arg("cell"), py::arg("tick"),
           R"(Has all robots drive a whole plan from where they stand, which nothing replaces.

steps: (n,) int32, how many cells each robot enters. cell, tick: (sum of steps,) int32, robot after
robot: each cell, and when it is entered. Robots pass each cell in the order of ticks; a robot's own
ascend. No two robots may have one tick and cell, nor may robots follow each other in a ring at one
tick: they would wait for each other. ValueError if the arrays differ in length.)")
      .def("release", &release,
           R"(Releases to each robot the cells that it needs in order not to brake.

Returns (robot, path_id, first, points, cells, released), the arrays of FleetFollow: robot (k,) int32
indices; path_id, first, points, released (k,) uint32; cells (sum of points,) int32, robot after
robot.)")
      .def(
          "refused", [](Run& run, int robot) { run.execution.refused(robot); }, py::arg("robot"),
          "Notes that a robot refused the path that it was sent; the path is given up.")
      .def(
          "close", [](Run& run, Cell cell, double until) { run.execution.close(cell, until); },
          py::arg("cell"), py::arg("until"), "Closes a cell until a time [s].")
      .def(
          "recall", [](Run& run, Cell cell) { run.execution.recall(cell); }, py::arg("cell"),
          "Stops the robot to which a cell was released before that cell, if it still can stop.")
      .def(
          "keep", [](Run& run, int robot, Cell cell) { return run.execution.keep(robot, cell); },
          py::arg("robot"), py::arg("cell"),
          R"(Keeps a cell for a robot that others are to set down there; returns whether it was free.

No other robot is released into it until the robot has come and left, or give_up(). Its journey goes
on there.)")
      .def(
          "give_up", [](Run& run, int robot) { run.execution.giveUp(robot); }, py::arg("robot"),
          "Gives up the cell kept for a robot.")
      .def(
          "set_units",
          [](Run& run, const Array<Cell>& cells) {
            run.execution.setUnits({cells.data(), cells.data() + cells.size()});
          },
          py::arg("cells"),
          "Sets the cells of aisles in which units stand, (m,) int32: loaded robots can't pass.")
      .def(
          "set_zone",
          [](Run& run, const Array<Cell>& cells) {
            run.execution.setZone({cells.data(), cells.data() + cells.size()});
          },
          py::arg("cells"),
          "Closes the cells (m,) int32 around people, and opens those of the call before; a robot "
          "inside goes on with what was released to it.")
      .def(
          "set_closed_zone",
          [](Run& run, const Array<Cell>& cells) {
            run.execution.setClosedZone({cells.data(), cells.data() + cells.size()});
          },
          py::arg("cells"),
          "Closes the cells (m,) int32 for robots outside of them, and opens those of the call "
          "before; robots inside may leave.")
      .def_property_readonly(
          "closing", [](const Run& run) { return run.execution.isClosing(); },
          "Whether a cell is closed by close(), or for an obstacle that a robot "
          "found there.")
      .def(
          "closed", [](const Run& run) { return array(run.execution.closed()); },
          "Returns the cells closed now, (m,) int32, with those of robots that are not controlled.")
      .def("states", &states, R"(Returns what is known of each robot by now, (n,) each.

(cell, stands, stalled, astray, lost, still_since, foreign, dropped): cell int32, where the robot
stands, or stood last, -1 beyond the floor. Of bool: stands, in the middle of a cell with nothing
released beyond it; stalled, broken, or does not drive although it may; astray, pushed off the
middle of its cell; lost, gave up finding back to one; foreign, busy with a command that is not the
fleet's; dropped, on a path of the fleet that was given up, since a copy of it came late.
still_since float64 [s]: since when it has stood although it has somewhere to go; the time of the
last report for all others.)")
      .def("stands", ofAll<bool>(&Execution::stands),
           "Returns which robots stand in the middle of a cell with nothing released beyond it, "
           "(n,) bool.")
      .def("waits_for", ofAll<int>(&Execution::waitsFor),
           "Returns the robot that each robot with a plan waits for, (n,) int32; -1 for none.")
      .def("hindrance", ofAll<std::uint8_t>(&Execution::hindrance),
           "Returns what keeps each robot from the next cell of its plan, (n,) uint8: 0 nothing, 1 "
           "the robot ahead, 2 one that passes the cell before it, 3 a turn beside it.")
      .def("next_tick", ofAll<int>(&Execution::nextTick),
           "Returns the tick of each robot's next step that was not released yet, (n,) int32; -1 "
           "at the end of its plan.")
      .def("still_since", ofAll<double>(&Execution::stillSince),
           "Returns since when each robot has stood although it has somewhere to go, (n,) float64 "
           "[s]; the time of the last report for all others.")
      .def(
          "holder", [](const Run& run, Cell cell) { return run.execution.holder(cell); },
          py::arg("cell"), "Returns the robot that holds a cell, -1 for none.")
      .def(
          "holders",
          [](const Run& run, const Array<Cell>& cells) {
            py::array_t<int> robots(cells.size());
            std::transform(cells.data(), cells.data() + cells.size(), robots.mutable_data(),
                           [&](Cell cell) { return run.execution.holder(cell); });
            return robots;
          },
          py::arg("cells"), "Returns the robot that holds each cell (n,), -1 for none: (n,) int32.")
      .def(
          "released", [](const Run& run, int robot) { return run.execution.released(robot); },
          py::arg("robot"), "Returns the cells ahead that a robot holds, the nearest first.")
      .def(
          "planned", [](const Run& run, int robot) { return run.execution.planned(robot); },
          py::arg("robot"), "Returns the cells planned for a robot beyond those released.")
      .def(
          "take_journey",
          [](Run& run, int robot) {
            const Journey journey = run.execution.takeJourney(robot);
            return py::make_tuple(journey.driven, journey.planned, journey.cells);
          },
          py::arg("robot"),
          R"(Returns (driven, planned, cells) of the journeys that a robot made since the last call.

driven: their duration [s]. planned: that of the plan, with the waits that the plan had [s]. cells:
how many cells the robot passed.)")
      .def_property_readonly(
          "blocked", [](const Run& run) { return run.execution.blocked(); },
          "How often a robot was BLOCKED before a cell that it held.");
}

}  // namespace fleet::python
