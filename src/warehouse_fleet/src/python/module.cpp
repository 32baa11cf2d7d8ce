// SPDX-License-Identifier: Apache-2.0
//
// The planner inside a Python process. This file translates; python/warehouse_fleet adds what is
// easier to write in Python.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "arrays.h"
#include "execution.h"
#include "warehouse_fleet/epibt.h"
#include "warehouse_fleet/validator.h"

namespace py = pybind11;

namespace fleet::python {
namespace {

using Flags = std::optional<Array<std::uint8_t>>;

Fleet makeFleet(const Array<Cell>& cell, const Array<Heading>& heading, const Array<Cell>& goal,
                const Flags& loaded, const std::optional<Array<Cell>>& home, const Flags& stopped,
                const Flags& committed, const std::optional<Array<Cell>>& closed,
                const std::optional<Array<Cell>>& tight, const std::optional<Array<Cell>>& zone) {
  Fleet fleet;
  fleet.cell = copied<Cell>(cell);
  fleet.heading = copied<Heading>(heading);
  fleet.goal = copied<Cell>(goal);
  fleet.loaded = copied(loaded);
  fleet.home = copied(home);
  fleet.stopped = copied(stopped);
  fleet.committed = copied(committed);
  fleet.closed = copied(closed);
  fleet.tight = copied(tight);
  fleet.zone = copied(zone);
  if (committed) {
    if (committed->ndim() != 2) throw py::value_error("committed must be (robots, ticks)");
    fleet.committed_ticks = static_cast<int>(committed->shape(1));
  }
  return fleet;
}

py::array actionsOf(const Plan& plan) {
  const py::ssize_t horizon = plan.horizon;
  return py::array_t<std::uint8_t>(
      {static_cast<py::ssize_t>(plan.actions.size()) / horizon, horizon},
      reinterpret_cast<const std::uint8_t*>(plan.actions.data()));
}

/// A planner with its floor.
struct Started {
  Started(std::shared_ptr<Planner> planner, std::shared_ptr<Floor> floor, const Rules& rules,
          std::uint64_t seed)
      : floor(std::move(floor)), planner(std::move(planner)) {
    this->planner->start(*this->floor, rules, seed);
  }
  std::shared_ptr<Floor> floor;
  std::shared_ptr<Planner> planner;
};

py::array plan(Started& started, const Fleet& fleet, double seconds, int attempts) {
  Plan plan;
  {
    py::gil_scoped_release others_may_run;
    started.planner->plan(fleet, {seconds, attempts}, plan);
  }
  if (plan.horizon < 1) throw FloorError("the planner answered without a plan");
  return actionsOf(plan);
}

void bindFleet(py::module_& module) {
  py::class_<Fleet> fleet(module, "Fleet", R"(The fleet at a planning step.

The properties are views of the arguments, empty for arrays that were left out.)");
  fleet.def(py::init(&makeFleet), py::arg("cell"), py::arg("heading"), py::arg("goal"),
            py::arg("loaded") = py::none(), py::arg("home") = py::none(),
            py::arg("stopped") = py::none(), py::arg("committed") = py::none(),
            py::arg("closed") = py::none(), py::arg("tight") = py::none(),
            py::arg("zone") = py::none(),
            R"(Copies what the planner is to see of n robots.

cell: (n,) int32. heading: (n,) uint8, quarter turns from +x towards +y. goal: (n,) int32 cells, -1:
none, the robot waits where it blocks no other. loaded: (n,) bool, the robot drives on the aisles;
default: none does. home: (n,) int32, a storage place that the robot may enter loaded; default: none.
stopped: (n,) bool, the robot stays in any case; default: none. committed: (n, ticks) uint8,
the next actions that each robot can no longer take back, in order, 255 from where it is free;
default: all are free. closed: cells that no robot may enter now. tight: cells where a load may pass
but has no room to turn. zone: cells that robots inside leave, and no other enters. ValueError if committed has another shape.)");
  fleet.def("__len__", &Fleet::size, "Returns the number of robots.");
  const auto field = [&](const char* name, auto member, const char* doc) {
    fleet.def_property_readonly(
        name,
        [member](const py::object& self) { return view(self.cast<const Fleet&>().*member, self); },
        doc);
  };
  field("cell", &Fleet::cell, "The cell of each robot, (n,) int32.");
  field("heading", &Fleet::heading,
        "The heading of each robot, (n,) uint8: quarter turns from +x towards +y.");
  field("goal", &Fleet::goal, "The goal of each robot, (n,) int32 cells, -1: none.");
  field("loaded", &Fleet::loaded, "Whether each robot carries a unit, (n,) uint8, or (0,).");
  field("home", &Fleet::home,
        "The storage place that each robot may enter loaded, (n,) int32, -1: none; or (0,).");
  field("stopped", &Fleet::stopped, "Whether each robot stays where it is, (n,) uint8, or (0,).");
  field("closed", &Fleet::closed, "The cells that no robot may enter, (m,) int32.");
  field("zone", &Fleet::zone, "The cells that robots may leave, but not enter, (m,) int32.");
  field("tight", &Fleet::tight, "The cells where loads have no room to turn, (m,) int32.");
  fleet.def_property_readonly(
      "committed",
      [](const py::object& self) {
        const auto& fleet = self.cast<const Fleet&>();
        return view(fleet.committed, self, {fleet.size(), fleet.committed_ticks});
      },
      "The actions that robots can no longer take back, (n, ticks) uint8; 255: free from there "
      "on.");
  fleet.def(
      "check",
      [](const Fleet& fleet, const Floor& floor, const std::vector<std::string>& names) {
        check(floor, fleet, names);
      },
      py::arg("floor"), py::arg("names") = std::vector<std::string>(),
      R"(Checks that the fleet can stand on a floor.

Raises FloorError where a robot stands in a wall, two stand in one cell, a goal is off the floor or
arrays differ in length. names: of the robots, for the message; default "robot <index>".)");
}

void bindRules(py::module_& module) {
  py::class_<Rules>(module, "Rules", "What robots may do in the same tick.")
      .def(py::init([](bool following, bool rings, bool turning) {
             return Rules{following, rings, turning};
           }),
           py::arg("following") = true, py::arg("rings") = false, py::arg("turning") = false,
           "Sets the rules; each argument is the property of its name.")
      .def_readonly("following", &Rules::following,
                    "Whether a robot may enter a cell in the tick in which another leaves it; else "
                    "the cell must have been left a tick before.")
      .def_readonly("rings", &Rules::rings,
                    "Whether robots that follow each other in a ring may all move in one tick.")
      .def_readonly("turning", &Rules::turning,
                    "Whether two loaded robots side by side may turn in one tick.");
}

void bindValidator(py::module_& module) {
  py::class_<Violation> violation(module, "Violation",
                                  "A conflict in a plan, or a step that its robot can not do.");
  py::enum_<Violation::Kind>(violation, "Kind", R"(What is wrong with a plan.

WALL: a robot drives where its deck has no edge, or into a closed cell. VERTEX: two robots are in one
cell. SWAP: two exchange cells. RING: several move around in a ring. FOLLOWING: a robot enters a cell
in the tick in which another leaves it. TURNING: two loaded robots side by side turn. COMMITMENT: a
robot does not do what it is committed to. STOPPED: a robot that is stopped moves.)")
      .value("WALL", Violation::Kind::kWall)
      .value("VERTEX", Violation::Kind::kVertex)
      .value("SWAP", Violation::Kind::kSwap)
      .value("RING", Violation::Kind::kRing)
      .value("FOLLOWING", Violation::Kind::kFollowing)
      .value("TURNING", Violation::Kind::kTurning)
      .value("COMMITMENT", Violation::Kind::kCommitment)
      .value("STOPPED", Violation::Kind::kStopped);
  violation.def_readonly("kind", &Violation::kind, "The rule that is broken.")
      .def_readonly("tick", &Violation::tick, "The tick of the action, 0 for the first.")
      .def_readonly("robots", &Violation::robots, "The indices of the robots involved.")
      .def_readonly("cell", &Violation::cell, "The cell where it happens.")
      .def("describe",
           py::overload_cast<const Violation&, const Floor&, const std::vector<std::string>&>(
               &describe),
           py::arg("floor"), py::arg("names") = std::vector<std::string>(),
           "Returns a sentence about the violation; names: of the robots, default \"robot "
           "<index>\".");
  module.def(
      "validate",
      [](const Floor& floor, const Fleet& fleet, const Array<std::uint8_t>& actions,
         const Rules& rules, int ticks) {
        const Plan plan = makePlan(actions);
        const py::gil_scoped_release release;
        return validate(floor, fleet, plan, rules, ticks);
      },
      py::arg("floor"), py::arg("fleet"), py::arg("actions"), py::arg("rules"),
      py::arg("ticks") = -1, R"(Returns all Violations in the first ticks of a plan.

fleet: as it stands, without conflicts. actions: (n, horizon) uint8 of Action. ticks: -1 for the whole
plan. Raises FloorError if the plan is not one action for each robot and tick.)");
}

/// What an option of this type is, for people.
template <typename T>
const char* kindOf() {
  if (std::is_same_v<T, bool>) return "true or false";
  return std::is_integral_v<T> ? "a whole number" : "a number";
}

std::unique_ptr<Started> startEpibt(std::shared_ptr<Floor> floor, const Rules& rules,
                                    std::uint64_t seed, const py::kwargs& keywords) {
  EpibtOptions options;
  const auto set = [&](const char* name, auto& value) {
    if (!keywords.contains(name)) return;
    using Type = std::decay_t<decltype(value)>;
    try {
      value = keywords[name].cast<Type>();
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(name) + " is " + std::string(py::repr(keywords[name])) +
                           "; " + kindOf<Type>() + " was expected");
    }
    keywords.attr("pop")(name);
  };
  set("depth", options.depth);
  set("horizon", options.horizon);
  set("turn_ticks", options.turn_ticks);
  set("revisits", options.revisits);
  set("pushes", options.pushes);
  set("exchanges", options.exchanges);
  set("patience", options.patience);
  set("pursuing", options.pursuing);
  set("window", options.window);
  set("goals_are_stops", options.goals_are_stops);
  set("table_bytes", options.table_bytes);
  set("whole_up_to", options.whole_up_to);
  set("threads", options.threads);
  set("table_work", options.table_work);
  set("renewal_work", options.renewal_work);
  set("renewal_age", options.renewal_age);
  set("against", options.against);
  set("crowd", options.crowd);
  set("resting", options.resting);
  set("at_lanes", options.at_lanes);
  set("streets", options.streets);
  set("memory", options.memory);
  for (const auto& unknown : keywords) {
    throw py::type_error("no such option: " + unknown.first.cast<std::string>());
  }
  return std::make_unique<Started>(makeEpibt(options), std::move(floor), rules, seed);
}

void bindPlanners(py::module_& module) {
  py::class_<Started>(module, "Planner", "A planner on the floor that it was started for.")
      .def("plan", &plan, py::arg("fleet"), py::arg("seconds") = 0.0, py::arg("attempts") = -1,
           R"(Returns what all robots do next, (n, horizon) uint8 of Action.

The plan has no conflicts and keeps to what is committed; it is asked for again a tick later. seconds:
computing time of the calling thread for the step [s]; 0: what the first plan needs. attempts: to
improve the plan, -1: as many as seconds allow. Equal steps give equal plans with seconds=0 and a
number of attempts, whatever the number of threads. Other threads of Python run meanwhile. FloorError without a plan.)")
      .def(
          "prepare", [](Started& started, double seconds) { started.planner->prepare(seconds); },
          py::arg("seconds") = std::numeric_limits<double>::infinity(),
          py::call_guard<py::gil_scoped_release>(),
          R"(Makes what every plan on the floor needs, ahead of the first.

That is the distance tables of all regions of a large floor; nothing on a small one, where plans make
their tables in time. seconds: by the clock at most [s]; without it equal plans follow.)")
      .def(
          "save",
          [](const Started& started, const std::string& path) { started.planner->save(path); },
          py::arg("path"),
          "Writes what was prepared into a file; raises RuntimeError if that can't be done.")
      .def(
          "load", [](Started& started, const std::string& path) { started.planner->load(path); },
          py::arg("path"),
          "Reads what was prepared for the same floor; raises RuntimeError for any other file.");
  module.attr("PURSUING") = EpibtOptions().pursuing;
  module.def("epibt", &startEpibt, py::arg("floor"), py::arg("rules") = Rules(),
             py::arg("seed") = 1, R"(Returns the planner of this package, started on a floor.

It plans by priority inheritance with backtracking over operations of several ticks (EPIBT). Options
by keyword, as in EpibtOptions (epibt.h): depth (ticks of an operation, 1 to 5; 0: 4, or 5 where the
first step has time for it), horizon (ticks of a plan, up to 7; 0: depth), turn_ticks, revisits, pushes,
exchanges, patience [ticks], pursuing (share of the passable cells), window (ticks of the windows for
few robots with much time, 7 to 31; 0: 15 where the first step has time for it; -1: none),
goals_are_stops, table_bytes, whole_up_to [cells], threads (0: one a core), table_work, renewal_work,
renewal_age [ticks], against (-1: 10, or 3 in windows), crowd, resting, at_lanes, streets, memory [ticks].
TypeError for another option.)");
  module.def(
      "load_planner",
      [](const std::string& path, const std::string& class_name, std::shared_ptr<Floor> floor,
         const Rules& rules, std::uint64_t seed) {
        return std::make_unique<Started>(loadPlanner(path, class_name), std::move(floor), rules,
                                         seed);
      },
      py::arg("path"), py::arg("class_name"), py::arg("floor"), py::arg("rules") = Rules(),
      py::arg("seed") = 1, R"(Returns a planner of a user's library, started on a floor.

path: of the shared library. class_name: of the fleet::Planner that it registers. RuntimeError says
what is missing.)");
}

}  // namespace
}  // namespace fleet::python

PYBIND11_MODULE(_core, module) {
  using namespace fleet::python;
  py::module_::import("warehouse_layout._core");  // knows Floor, and FloorError
  bindRules(module);
  bindFleet(module);
  bindValidator(module);
  bindPlanners(module);
  bindExecution(module);
}
