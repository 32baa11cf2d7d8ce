// SPDX-License-Identifier: Apache-2.0
//
// The planner inside a Python process. This file translates; python/warehouse_fleet adds what is
// easier said in Python.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
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
                const std::optional<Array<Cell>>& tight) {
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

/// A planner with the floor that it drives on.
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
  py::class_<Fleet> fleet(module, "Fleet");
  fleet.def(py::init(&makeFleet), py::arg("cell"), py::arg("heading"), py::arg("goal"),
            py::arg("loaded") = py::none(), py::arg("home") = py::none(),
            py::arg("stopped") = py::none(), py::arg("committed") = py::none(),
            py::arg("closed") = py::none(), py::arg("tight") = py::none());
  fleet.def("__len__", &Fleet::size);
  const auto field = [&](const char* name, auto member) {
    fleet.def_property_readonly(name, [member](const py::object& self) {
      return view(self.cast<const Fleet&>().*member, self);
    });
  };
  field("cell", &Fleet::cell);
  field("heading", &Fleet::heading);
  field("goal", &Fleet::goal);
  field("loaded", &Fleet::loaded);
  field("home", &Fleet::home);
  field("stopped", &Fleet::stopped);
  field("closed", &Fleet::closed);
  field("tight", &Fleet::tight);
  fleet.def_property_readonly("committed", [](const py::object& self) {
    const auto& fleet = self.cast<const Fleet&>();
    return view(fleet.committed, self, {fleet.size(), fleet.committed_ticks});
  });
  fleet.def(
      "check",
      [](const Fleet& fleet, const Floor& floor, const std::vector<std::string>& names) {
        check(floor, fleet, names);
      },
      py::arg("floor"), py::arg("names") = std::vector<std::string>());
}

void bindRules(py::module_& module) {
  py::class_<Rules>(module, "Rules")
      .def(py::init([](bool following, bool rings, bool turning) {
             return Rules{following, rings, turning};
           }),
           py::arg("following") = true, py::arg("rings") = false, py::arg("turning") = false)
      .def_readonly("following", &Rules::following)
      .def_readonly("rings", &Rules::rings)
      .def_readonly("turning", &Rules::turning);
}

void bindValidator(py::module_& module) {
  py::class_<Violation> violation(module, "Violation");
  py::enum_<Violation::Kind>(violation, "Kind")
      .value("WALL", Violation::Kind::kWall)
      .value("VERTEX", Violation::Kind::kVertex)
      .value("SWAP", Violation::Kind::kSwap)
      .value("RING", Violation::Kind::kRing)
      .value("FOLLOWING", Violation::Kind::kFollowing)
      .value("TURNING", Violation::Kind::kTurning)
      .value("COMMITMENT", Violation::Kind::kCommitment)
      .value("STOPPED", Violation::Kind::kStopped);
  violation.def_readonly("kind", &Violation::kind)
      .def_readonly("tick", &Violation::tick)
      .def_readonly("robots", &Violation::robots)
      .def_readonly("cell", &Violation::cell)
      .def("describe",
           py::overload_cast<const Violation&, const Floor&, const std::vector<std::string>&>(
               &describe),
           py::arg("floor"), py::arg("names") = std::vector<std::string>());
  module.def(
      "validate",
      [](const Floor& floor, const Fleet& fleet, const Array<std::uint8_t>& actions,
         const Rules& rules,
         int ticks) { return validate(floor, fleet, makePlan(actions), rules, ticks); },
      py::arg("floor"), py::arg("fleet"), py::arg("actions"), py::arg("rules"),
      py::arg("ticks") = -1);
}

std::unique_ptr<Started> startEpibt(std::shared_ptr<Floor> floor, const Rules& rules,
                                    std::uint64_t seed, const py::kwargs& given) {
  EpibtOptions options;
  const auto set = [&](const char* name, auto& value) {
    if (!given.contains(name)) return;
    value = given[name].cast<std::decay_t<decltype(value)>>();
    given.attr("pop")(name);
  };
  set("depth", options.depth);
  set("horizon", options.horizon);
  set("turn_ticks", options.turn_ticks);
  set("revisits", options.revisits);
  set("pushes", options.pushes);
  set("exchanges", options.exchanges);
  set("patience", options.patience);
  set("goals_are_stops", options.goals_are_stops);
  set("table_bytes", options.table_bytes);
  set("table_work", options.table_work);
  set("renewal_work", options.renewal_work);
  set("renewal_age", options.renewal_age);
  set("against", options.against);
  set("crowd", options.crowd);
  set("resting", options.resting);
  set("at_lanes", options.at_lanes);
  set("memory", options.memory);
  for (const auto& unknown : given) {
    throw py::type_error("no such option: " + unknown.first.cast<std::string>());
  }
  return std::make_unique<Started>(makeEpibt(options), std::move(floor), rules, seed);
}

void bindPlanners(py::module_& module) {
  py::class_<Started>(module, "Planner")
      .def("plan", &plan, py::arg("fleet"), py::arg("seconds") = 0.0, py::arg("attempts") = -1);
  module.def("epibt", &startEpibt, py::arg("floor"), py::arg("rules") = Rules(),
             py::arg("seed") = 1);
  module.def(
      "load_planner",
      [](const std::string& path, const std::string& class_name, std::shared_ptr<Floor> floor,
         const Rules& rules, std::uint64_t seed) {
        return std::make_unique<Started>(loadPlanner(path, class_name), std::move(floor), rules,
                                         seed);
      },
      py::arg("path"), py::arg("class_name"), py::arg("floor"), py::arg("rules") = Rules(),
      py::arg("seed") = 1);
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
