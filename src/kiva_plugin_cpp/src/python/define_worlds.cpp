// SPDX-License-Identifier: Apache-2.0
//
// The class Worlds as Python sees it.
#include "worlds.h"

namespace kiva::python {

void defineWorlds(py::module_& m) {
  py::class_<Worlds> worlds(m, "Worlds");
  worlds.def(py::init<std::vector<HostPtr>, unsigned>(), py::arg("worlds"), py::arg("threads"));
  worlds.def("__len__", &Worlds::size);
  worlds.def("step", &Worlds::step, py::arg("steps") = 1, py::arg("until_idle") = false,
             R"(Advances all worlds by so many steps, on all threads, without the GIL.

until_idle: a world stops as soon as none of its robots has a command, after one step at least.
Returns how many steps each made, (n,) int64. ValueError for a negative number, RuntimeError for a
world that another thread uses; Ctrl-C ends it between steps.)");
  worlds.def("post", &Worlds::post, py::arg("world"), py::arg("commands"),
             R"(Posts commands, (k,) of dtype COMMAND, each to the world of that index, (k,) or one.

Errors as of World.post(), all or none; IndexError for an index without a world.)");
  worlds.def("restore", &Worlds::restore, py::arg("world"), py::arg("checkpoint"),
             R"(Restores the worlds of those indices, (k,) or one, from one checkpoint or k of them.

CheckpointError, with that world unchanged, if the bytes are damaged.)");
  worlds.def("place", &Worlds::place, py::arg("world"), py::arg("kiva_id"), py::arg("x"),
             py::arg("y"), py::arg("yaw"),
             R"(Puts robots at those places, at rest: arrays (k,), in world [m, rad].

ValueError for an unknown robot or arrays of different lengths.)");
  worlds.def("drive", &Worlds::drive, py::arg("left"), py::arg("right"),
             R"(Sets the wheel speeds of robots without a command, (n, robots) [rad/s].

The motors keep a speed until the next call or command, with all their torque and no faster than the
robot's top speed; no laser stops them. Returns (n, robots) bool: which robots took their speeds;
robots with a command don't. ValueError for another shape, NaN or infinity.)");
  worlds.def(
      "scans", &Worlds::scans,
      R"(Returns laser ranges of now: (n, robots, rays) float32 [m], rows as of World.scans().

A read-only view, current until the next call.)");
  worlds.def(
      "events", &Worlds::events,
      "Returns the events of the last step(): a list of (world, time, kind, model, other, text, "
      "command), worlds in order.");
  worlds.def("state_hash", &Worlds::stateHash,
             "Returns World.state_hash() of each world: (n,) uint64.");
  worlds.def_property_readonly("storage_units", &Worlds::storageUnits,
                               "World.storage_units of each world: (n, units). A copy.");
  worlds.def_property_readonly("threads", &Worlds::threads,
                               "How many threads step the worlds, the caller's among them.");
  const auto add = [&worlds](const char* name, auto field, auto zero, const char* doc) {
    const auto get = [field](const Worlds& w) { return w.column<decltype(zero)>(field); };
    worlds.def_property_readonly(name, get, doc);
  };
  add("x", &FleetRows::x, 0.0, "(n, robots) float64 in world [m]. A view.");
  add("y", &FleetRows::y, 0.0, "(n, robots) float64 in world [m]. A view.");
  add("yaw", &FleetRows::yaw, 0.0, "(n, robots) float64 [rad], unwrapped. A view.");
  add("vx", &FleetRows::vx, 0.0, "(n, robots) float64, in world [m/s]. A view.");
  add("vy", &FleetRows::vy, 0.0, "(n, robots) float64, in world [m/s]. A view.");
  add("yaw_rate", &FleetRows::yaw_rate, 0.0, "(n, robots) float64 [rad/s]. A view.");
  add("left_wheel_speed", &FleetRows::left_wheel_speed, 0.0,
      "(n, robots) float64 [rad/s]. A view.");
  add("right_wheel_speed", &FleetRows::right_wheel_speed, 0.0,
      "(n, robots) float64 [rad/s]. A view.");
  add("tower", &FleetRows::tower, 0.0, "(n, robots) float64: height above its rest [m]. A view.");
  add("status", &FleetRows::status, std::uint8_t(), "(n, robots) uint8 of Status. A view.");
  add("state", &FleetRows::state, std::uint8_t(), "(n, robots) uint8 of State. A view.");
  add("last_end", &FleetRows::last_end, std::uint8_t(),
      "(n, robots) uint8, as Fleet.last_end. A view.");
  add("shelf_id", &FleetRows::shelf_id, std::int32_t(),
      "(n, robots) int32: the storage unit that each carries, 0 = none. A view.");
  worlds.def_property_readonly(
      "counts", &Worlds::counts,
      "(n, robots, kinds) uint32: events of each EventKind, by its value, about each robot in the "
      "last step(). A view.");
}

}  // namespace kiva::python
