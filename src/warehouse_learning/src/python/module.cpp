// SPDX-License-Identifier: Apache-2.0
//
// The task of many warehouses for Python: arrays in, arrays out.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/floor.h"
#include "core/goals.h"
#include "core/observer.h"
#include "core/rules.h"
#include "core/state.h"
#include "kiva_plugin_cpp/command.h"
#include "kiva_plugin_cpp/fleet.h"
#include "python/arrays.h"
#include "python/rware.h"

namespace py = pybind11;

namespace learning::python {
namespace {

/// Returns `value`; throws IndexError unless low <= value < high.
int within(const char* name, py::ssize_t value, py::ssize_t low, py::ssize_t high) {
  if (value >= low && value < high) return static_cast<int>(value);
  throw py::index_error(std::string(name) + " has " + std::to_string(value) + "; " +
                        std::to_string(low) + " to " + std::to_string(high - 1) + " was expected");
}

std::shared_ptr<RimmedFloor> makeFloor(int width, int height, int rim, std::array<double, 2> origin,
                                       double spacing, const py::object& passable,
                                       const py::object& storage,
                                       const std::vector<int>& stations) {
  if (rim < 0 || width <= 2 * rim || height <= 2 * rim) {
    throw py::value_error("floor: expected cells within a rim");
  }
  const int cells = width * height;
  const auto open = checked<bool>("passable", passable, {cells});
  const auto places = checked<bool>("storage", storage, {cells});
  for (const int cell : stations) within("stations", cell, 0, cells);
  layout::FloorDescription description;
  description.width = width;
  description.height = height;
  description.passable.assign(open.data(), open.data() + open.size());
  description.storage.assign(places.data(), places.data() + places.size());
  return std::make_shared<RimmedFloor>(description, rim,
                                       layout::Raster{origin[0], origin[1], spacing}, stations);
}

using Places = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Returns (cell, heading), each of the shape of x.
py::tuple locate(const RimmedFloor& floor, const Places& x, const Places& y, const Places& yaw) {
  if (y.size() != x.size() || yaw.size() != x.size()) {
    throw py::value_error("x, y and yaw: expected arrays of one shape");
  }
  const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
  py::array_t<std::int32_t> cell(shape);
  py::array_t<std::int8_t> heading(shape);
  for (py::ssize_t i = 0; i < x.size(); ++i) {
    cell.mutable_data()[i] = floor.cellOf(x.data()[i], y.data()[i]);
    heading.mutable_data()[i] = static_cast<std::int8_t>(headingOf(yaw.data()[i]));
  }
  return py::make_tuple(cell, heading);
}

/// Returns rows of the task as a read-only array that lives as long as the task.
template <typename T>
py::array view(const Table<T>& table, const py::object& owner) {
  py::array_t<T> array({table.rows(), table.columns()}, table[0], owner);
  array.attr("setflags")(py::arg("write") = false);
  return std::move(array);
}

template <typename T>
py::array copy(const Table<T>& table) {
  return py::array_t<T>({table.rows(), table.columns()}, table[0]);
}

class Task {
 public:
  Task(std::shared_ptr<RimmedFloor> floor, int warehouses, std::vector<std::int32_t> kiva_id,
       std::vector<std::int32_t> shelf_id, int radius, bool reserve)
      : floor_(std::move(floor)),
        state_(within("warehouses", warehouses, 1, 1 << 24), static_cast<int>(kiva_id.size()),
               static_cast<int>(shelf_id.size()), floor_->size()),
        goals_(*floor_, state_),
        rules_(*floor_, &state_, &goals_, reserve),
        observer_(*floor_, state_, goals_, within("radius", radius, 0, floor_->rim() + 1)),
        possible_(state_.warehouses(), state_.robots() * kActions),
        kiva_id_(std::move(kiva_id)),
        shelf_id_(std::move(shelf_id)),
        commands_(py::module_::import("kiva_plugin_cpp").attr("COMMAND")) {
    for (std::size_t unit = 0; unit < shelf_id_.size(); ++unit) {
      const int id = within("shelf_id", shelf_id_[unit], 0, 1 << 24);
      if (id >= static_cast<int>(unit_of_.size())) unit_of_.resize(id + 1, kNone);
      unit_of_[id] = static_cast<int>(unit);
    }
  }

  void beginEpisode(int w, const py::object& unit_cell, const py::object& requested) {
    within("warehouse", w, 0, state_.warehouses());
    const auto asked = checked<bool>("requested", requested, {state_.units()});
    std::copy_n(asked.data(), state_.units(), state_.requested[w]);
    state_.served.fill(w, false);
    state_.turning.fill(w, false);
    std::copy_n(state_.cell[w], state_.robots(), state_.bound_for[w]);
    goals_.begin(w);
    placeUnits(w, unit_cell);
  }

  void placeUnits(int w, const py::object& unit_cell) {
    within("warehouse", w, 0, state_.warehouses());
    const auto cells = checked<std::int32_t>("unit_cell", unit_cell, {state_.units()});
    for (int unit = 0; unit < state_.units(); ++unit) {
      within("unit_cell", cells.at(unit), kNone, floor_->size());
    }
    std::copy_n(cells.data(), state_.units(), state_.unit_cell[w]);
    state_.unit_at.fill(w, kNone);
    for (int unit = 0; unit < state_.units(); ++unit) {
      if (cells.at(unit) != kNone) state_.unit_at[w][cells.at(unit)] = unit;
    }
    goals_.changed(w);
    is_possible_known_ = false;
  }

  using Worlds = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;
  void update(const Worlds& which, const py::object& x, const py::object& y, const py::object& yaw,
              const py::object& status, const py::object& shelf_id) {
    const auto xs = byRobot<double>("x", x), ys = byRobot<double>("y", y);
    const auto yaws = byRobot<double>("yaw", yaw);
    const auto statuses = byRobot<std::uint8_t>("status", status);
    const auto shelves = byRobot<std::int32_t>("shelf_id", shelf_id);
    is_possible_known_ = false;
    for (py::ssize_t k = 0; k < which.size(); ++k) {
      const int w = within("which", which.data()[k], 0, state_.warehouses());
      for (int robot = 0; robot < state_.robots(); ++robot) {
        const int shelf = within("shelf_id", shelves.at(w, robot), 0, unit_of_.size());
        state_.cell[w][robot] = floor_->cellOf(xs.at(w, robot), ys.at(w, robot));
        state_.heading[w][robot] = static_cast<std::int8_t>(headingOf(yaws.at(w, robot)));
        state_.busy[w][robot] = statuses.at(w, robot) != std::uint8_t(kiva::Status::kIdle);
        state_.load[w][robot] = shelf == 0 ? kNone : unit_of_[shelf];
      }
    }
  }

  py::array possible() {
    return py::array_t<bool>({state_.warehouses(), state_.robots(), kActions}, knowPossible()[0]);
  }

  /// Returns (done, world, commands).
  py::tuple begin(const py::object& actions) {
    const auto chosen = byRobot<std::int8_t>("actions", actions);
    for (py::ssize_t i = 0; i < chosen.size(); ++i) {
      within("actions", chosen.data()[i], 0, kActions);
    }
    py::array_t<bool> done({state_.warehouses(), state_.robots()});
    const auto orders = rules_.begin(knowPossible()[0], chosen.data(), done.mutable_data());
    is_possible_known_ = false;
    py::array_t<std::int32_t> worlds(static_cast<py::ssize_t>(orders.size()));
    py::array rows(commands_, static_cast<py::ssize_t>(orders.size()));
    if (rows.itemsize() != sizeof(kiva::Command)) throw py::type_error("COMMAND has changed");
    auto* row = static_cast<kiva::Command*>(rows.mutable_data());
    for (std::size_t k = 0; k < orders.size(); ++k) {
      worlds.mutable_at(k) = orders[k].warehouse;
      *row++ = command(orders[k]);
    }
    return py::make_tuple(done, worlds, rows);
  }

  /// Returns (refused, collided, [warehouse with collisions]).
  py::tuple takeEvents(const py::object& done, const py::object& counts) const {
    const auto obeyed = byRobot<bool>("done", done);
    const auto events = checked<std::uint32_t>(
        "counts", counts, {state_.warehouses(), state_.robots(), kiva::Event::kKinds});
    Table<bool> refused(state_.warehouses(), state_.robots());
    Table<bool> collided(state_.warehouses(), state_.robots());
    py::list hit;
    for (int w = 0; w < state_.warehouses(); ++w) {
      for (int robot = 0; robot < state_.robots(); ++robot) {
        const bool idles = !obeyed.at(w, robot) && !state_.busy[w][robot];
        refused[w][robot] = idles || events.at(w, robot, int(kiva::Event::Kind::kRefused)) > 0;
        collided[w][robot] = events.at(w, robot, int(kiva::Event::Kind::kCollision)) > 0;
      }
      const bool* const any = collided[w];
      if (std::find(any, any + state_.robots(), true) != any + state_.robots()) hit.append(w);
    }
    return py::make_tuple(copy(refused), copy(collided), hit);
  }

  /// Returns (lifted, dropped, stored, [(warehouse, robot)]).
  py::tuple settle() {
    const Outcome outcome = rules_.settle();
    is_possible_known_ = false;
    py::list arrived;
    for (const Who& who : outcome.arrived) {
      arrived.append(py::make_tuple(who.warehouse, who.robot));
    }
    return py::make_tuple(copy(outcome.lifted), copy(outcome.dropped), copy(outcome.stored),
                          arrived);
  }

  void deliver(int w, int robot, int next) {
    within("warehouse", w, 0, state_.warehouses());
    within("robot", robot, 0, state_.robots());
    const int unit = within("load", state_.load[w][robot], 0, state_.units());
    state_.served[w][unit] = true;
    state_.requested[w][within("next", next, 0, state_.units())] = true;
    state_.requested[w][unit] = false;
    goals_.end(w, robot);
  }

  void renewGoals() { goals_.renew(); }

  py::array_t<std::int32_t> distance() const {
    py::array_t<std::int32_t> out({state_.warehouses(), state_.robots()});
    for (int w = 0; w < state_.warehouses(); ++w) {
      for (int robot = 0; robot < state_.robots(); ++robot) {
        out.mutable_at(w, robot) = goals_.distance(w, robot);
      }
    }
    return out;
  }

  py::object way(int w, int robot) const {
    within("warehouse", w, 0, state_.warehouses());
    const Way* way = goals_.way(w, within("robot", robot, 0, state_.robots()));
    if (!way) return py::none();
    return py::array_t<std::int16_t>(static_cast<py::ssize_t>(way->size()), way->data());
  }

  void observe(const py::object& out) {
    const auto buffer = py::array::ensure(out);
    const py::ssize_t size = buffer && buffer.ndim() == 3 ? buffer.shape(2) : 0;
    if (size < observer_.size()) {
      throw py::value_error("out: expected at least " + std::to_string(observer_.size()) +
                            " numbers a robot");
    }
    auto rows = checked<float>("out", out, {state_.warehouses(), state_.robots(), size});
    observer_.observe(rows.mutable_data(), static_cast<int>(size));
  }

  const TaskState& state() const { return state_; }
  const Goals& goals() const { return goals_; }

 private:
  template <typename T>
  Array<T> byRobot(const char* name, const py::object& argument) const {
    return checked<T>(name, argument, {state_.warehouses(), state_.robots()});
  }

  const Table<bool>& knowPossible() {
    if (!is_possible_known_) rules_.possible(possible_[0]);
    is_possible_known_ = true;
    return possible_;
  }

  kiva::Command command(const Order& order) const {
    kiva::Command out;
    out.kiva_id = kiva_id_[order.robot];
    if (order.action == kForward) {
      const int heading = state_.heading[order.warehouse][order.robot];
      const double way = heading < 2 ? floor_->spacing() : -floor_->spacing();
      const bool along_x = heading % 2 == 0;
      out.kind = along_x ? kiva::Command::Kind::kMoveX : kiva::Command::Kind::kMoveY;
      (along_x ? out.x : out.y) = way;
    } else if (order.action == kLift) {
      out.kind = kiva::Command::Kind::kLift;
      out.lift = state_.load[order.warehouse][order.robot] == kNone;
      out.shelf_id = shelf_id_[order.unit];
    } else {
      out.kind = kiva::Command::Kind::kRotate;
      out.direction = order.action == kLeft ? 1 : -1;
    }
    return out;
  }

  std::shared_ptr<RimmedFloor> floor_;
  TaskState state_;
  Goals goals_;
  TaskRules rules_;
  Observer observer_;
  Table<bool> possible_;  // result of TaskRules::possible
  bool is_possible_known_ = false;
  std::vector<std::int32_t> kiva_id_, shelf_id_;
  std::vector<int> unit_of_;  // by shelf_id
  py::dtype commands_;
};

void defineFloor(py::module_& m) {
  py::class_<RimmedFloor, std::shared_ptr<RimmedFloor>>(m, "Floor")
      .def(py::init(&makeFloor), py::arg("width"), py::arg("height"), py::arg("rim"),
           py::arg("origin"), py::arg("spacing"), py::arg("passable"), py::arg("storage"),
           py::arg("stations"),
           R"(A floor of width x height cells, numbered row by row, with a rim that is none of it.

origin: (x, y) of the centre of cell 0 in world [m]; spacing [m]. passable, storage: (cells,) bool.
stations: cells. ValueError, IndexError for what is none of that.)")
      .def("locate", &locate, py::arg("x"), py::arg("y"), py::arg("yaw"),
           "(cell, heading) that are nearest to places in world [m, rad], int32 and int8 arrays of "
           "their shape; heading counts quarter turns.");
}

void defineTask(py::module_& m) {
  py::class_<Task> task(
      m, "Task",
      "The task in many warehouses at once. Arrays are (warehouses, robots), "
      "unless stated otherwise; another type or shape is a ValueError, a number out of range "
      "an IndexError.");
  task.def(py::init<std::shared_ptr<RimmedFloor>, int, std::vector<std::int32_t>,
                    std::vector<std::int32_t>, int, bool>(),
           py::arg("floor"), py::arg("warehouses"), py::arg("kiva_id"), py::arg("shelf_id"),
           py::arg("radius"), py::arg("reserve"),
           "kiva_id, shelf_id: of each warehouse's robots and units. radius: of the neighbourhood "
           "[cells], at most the floor's rim. reserve: as of warehouse_learning.Options.");
  task.def("update", &Task::update, py::arg("which"), py::arg("x"), py::arg("y"), py::arg("yaw"),
           py::arg("status"), py::arg("shelf_id"),
           "Takes in where the robots of warehouses `which`, (k,), are and what they carry.");
  task.def("begin_episode", &Task::beginEpisode, py::arg("warehouse"), py::arg("unit_cell"),
           py::arg("requested"),
           "After update(): units stand in those cells, (units,) int32; requested, (units,) bool.");
  task.def("place_units", &Task::placeUnits, py::arg("warehouse"), py::arg("unit_cell"),
           "Units stand in those cells, (units,) int32; -1 = carried.");
  task.def("possible", &Task::possible, "(warehouses, robots, 5) bool: what each may choose now.");
  task.def("begin", &Task::begin, py::arg("actions"),
           "Robots begin what they may of actions, int8. Returns (done, world, commands): "
           "who does its action, bool, and what is to be posted, (k,) int32 and COMMAND.");
  task.def("take_events", &Task::takeEvents, py::arg("done"), py::arg("counts"),
           "After update(): who was refused, and who has collided, by begin()'s `done` and by "
           "Worlds.counts. (refused, collided, hit): bool, and a list of warehouses.");
  task.def(
      "settle", &Task::settle,
      "After update(): what came of it. (lifted, dropped, stored, arrived): bool, and a list of "
      "(warehouse, robot) that stand at a station with a load.");
  task.def("deliver", &Task::deliver, py::arg("warehouse"), py::arg("robot"), py::arg("next"),
           "What the robot carries is delivered, and unit `next` is requested in its place.");
  task.def("renew_goals", &Task::renewGoals, "Finds goals for those that have none.");
  task.def("distance", &Task::distance, "int32: [cells] to each robot's goal; 0 without a way.");
  task.def("way", &Task::way, py::arg("warehouse"), py::arg("robot"),
           "(cells,) int16: how far each cell is from the robot's goal [cells], 32767 = no way; "
           "None without a goal.");
  task.def("observe", &Task::observe, py::arg("out"),
           "Fills the first 17 + (2 radius + 1)^2 * 7 numbers of each robot's row in `out`, "
           "(warehouses, robots, size) float32.");
  const auto add = [&task](const char* name, auto table, const char* doc) {
    const auto get = [table](const py::object& self) {
      return view(self.cast<const Task&>().state().*table, self);
    };
    task.def_property_readonly(name, get, doc);
  };
  add("cell", &TaskState::cell, "int32. A view.");
  add("heading", &TaskState::heading, "int8: quarter turns from +x. A view.");
  add("busy", &TaskState::busy, "bool: still at an action. A view.");
  add("load", &TaskState::load, "int32: the unit that it carries, -1 = none. A view.");
  add("unit_cell", &TaskState::unit_cell, "(warehouses, units) int32, -1 = carried. A view.");
  add("requested", &TaskState::requested, "(warehouses, units) bool. A view.");
  const auto goals = [](const py::object& self) {
    return view(self.cast<const Task&>().goals().cells(), self);
  };
  task.def_property_readonly("goal", goals, "int32: the cell that each had better go to. A view.");
}

}  // namespace
}  // namespace learning::python

PYBIND11_MODULE(_core, m) {
  m.doc() = "The task that robots learn, as the rules say; physics is kiva_plugin_cpp's.";
  learning::python::defineFloor(m);
  learning::python::defineTask(m);
  learning::python::defineRware(m);
}
