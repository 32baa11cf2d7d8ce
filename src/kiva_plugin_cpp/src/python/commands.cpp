// SPDX-License-Identifier: Apache-2.0
//
// Commands to the robots of one world.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "host.h"

namespace kiva::python {
namespace {

void checkFinite(const char* name, double value, std::size_t i) {
  if (std::isfinite(value)) return;
  throw py::value_error(std::string(name) + " of command " + std::to_string(i) + " is " +
                        text(py::float_(value)) + "; expected a finite number");
}

}  // namespace

void checkRobot(const Host& host, std::int32_t id) {
  if (host.world.fleet().find(id) < 0) {
    throw py::value_error("kiva_id: there is no robot kiva" + std::to_string(id));
  }
}

void checkCommand(const Host& host, const Command& command, std::size_t i) {
  if (command.kind >= Command::Kind::kFollow) {
    throw py::value_error("kind of command " + std::to_string(i) + " is " +
                          std::to_string(static_cast<int>(command.kind)) + "; expected 0 to 7");
  }
  const bool may_be_all =
      command.kind == Command::Kind::kStop || command.kind == Command::Kind::kGoOn;
  if (!may_be_all || command.kiva_id != 0) checkRobot(host, command.kiva_id);
  checkFinite("x", command.x, i);
  checkFinite("y", command.y, i);
}

py::array_t<Command, py::array::c_style> commandRows(const py::array& commands) {
  const py::dtype expected = py::dtype::of<Command>();
  if (!commands.dtype().equal(expected)) {
    throw py::type_error("commands: expected an array of dtype kiva_plugin_cpp.COMMAND, " +
                         text(expected) + ", not " + text(commands.dtype()));
  }
  if (commands.ndim() > 1) {
    throw py::value_error("commands: expected shape (n,), not " + text(commands.attr("shape")));
  }
  return py::array_t<Command, py::array::c_style>::ensure(commands);
}

namespace {

/// Posts all commands, or none if one of them is wrong.
void postAll(Host& host, const Command* commands, std::size_t count) {
  const auto lock = host.use();
  for (std::size_t i = 0; i < count; ++i) checkCommand(host, commands[i], i);
  for (std::size_t i = 0; i < count; ++i) host.world.post(commands[i]);
}

void post(Host& host, const py::array& commands) {
  const auto rows = commandRows(commands);
  postAll(host, rows.data(), static_cast<std::size_t>(rows.size()));
}

/// Returns the number of commands in the columns: the one length that is not 1.
template <typename... Columns>
std::size_t lengthOf(const Columns&... columns) {
  py::ssize_t length = 1;
  const char* longest = nullptr;
  const auto check = [&](const auto& column) {
    if (column.isOne()) return;
    if (longest && column.size() != length) {
      throw py::value_error(std::string(column.name()) + " has " + std::to_string(column.size()) +
                            " entries and " + longest + " has " + std::to_string(length));
    }
    longest = column.name();
    length = column.size();
  };
  (check(columns), ...);
  return static_cast<std::size_t>(length);
}

template <typename Fill, typename... Columns>
void postColumns(Host& host, Command::Kind kind, Fill fill, const Columns&... columns) {
  std::vector<Command> commands(lengthOf(columns...));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i].kind = kind;
    fill(commands[i], columns[static_cast<py::ssize_t>(i)]...);
  }
  postAll(host, commands.data(), commands.size());
}

using Ids = Numbers<std::int32_t>;
using Counts = Numbers<std::uint32_t>;
using Reals = Numbers<double>;

void mov(Host& host, const ArrayLike& kiva_id, const ArrayLike& x, const ArrayLike& y) {
  const auto fill = [](Command& c, int id, double to_x, double to_y) {
    c.kiva_id = id;
    c.x = to_x;
    c.y = to_y;
  };
  postColumns(host, Command::Kind::kMoveTo, fill, Ids("kiva_id", kiva_id), Reals("x", x),
              Reals("y", y));
}

void movAlong(Host& host, Command::Kind kind, const ArrayLike& kiva_id, const ArrayLike& distance) {
  const auto fill = [kind](Command& c, int id, double way) {
    c.kiva_id = id;
    (kind == Command::Kind::kMoveX ? c.x : c.y) = way;
  };
  postColumns(host, kind, fill, Ids("kiva_id", kiva_id), Reals("distance", distance));
}

void rot(Host& host, const ArrayLike& kiva_id, const ArrayLike& direction) {
  const auto fill = [](Command& c, int id, int way) {
    c.kiva_id = id;
    c.direction = way;
  };
  postColumns(host, Command::Kind::kRotate, fill, Ids("kiva_id", kiva_id),
              Ids("direction", direction));
}

void lift(Host& host, const ArrayLike& kiva_id, const ArrayLike& status,
          const ArrayLike& shelf_id) {
  const auto fill = [](Command& c, int id, int what, int shelf) {
    c.kiva_id = id;
    c.lift = what;
    c.shelf_id = shelf;
  };
  postColumns(host, Command::Kind::kLift, fill, Ids("kiva_id", kiva_id), Ids("status", status),
              Ids("shelf_id", shelf_id));
}

void cancel(Host& host, const ArrayLike& kiva_id) {
  const auto fill = [](Command& c, int id) { c.kiva_id = id; };
  postColumns(host, Command::Kind::kCancel, fill, Ids("kiva_id", kiva_id));
}

void stop(Host& host, const ArrayLike& kiva_id, bool stop) {
  const auto fill = [](Command& c, int id) { c.kiva_id = id; };
  postColumns(host, stop ? Command::Kind::kStop : Command::Kind::kGoOn, fill,
              Ids("kiva_id", kiva_id));
}

/// Makes a robot fail with `kind`; kind 0 repairs it.
void fail(Host& host, std::int32_t kiva_id, int kind, double repair_after) {
  const auto lock = host.use();
  if (kind == 0) return host.world.repair(kiva_id);
  const bool is_known = kind > 0 && kind <= kFailureKinds;
  if (!is_known) throw py::value_error("kind is " + std::to_string(kind) + "; expected 0 to 5");
  host.world.fail(kiva_id, static_cast<Failure>(kind), repair_after);
}

void steer(Host& host, std::int32_t kiva_id, double speed, double turn_rate) {
  const auto lock = host.use();
  host.world.steer(kiva_id, speed, turn_rate);
}

void beginSteering(Host& host, std::int32_t kiva_id) {
  const auto lock = host.use();
  host.world.beginSteering(kiva_id);
}

void endSteering(Host& host, std::int32_t kiva_id) {
  const auto lock = host.use();
  host.world.endSteering(kiva_id);
}

void checkSpeeds(const Reals& speeds) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(speeds.size()); ++k) {
    if (speeds.data()[k] > 0) continue;
    throw py::value_error("max_speed of point " + std::to_string(k) + " is " +
                          text(py::float_(speeds.data()[k])) + "; expected a number above 0");
  }
}

/// Posts a path for each row, or none if one is wrong. Row i has the next `points[i]` entries of x,
/// y and, unless that is empty, max_speed.
void follow(Host& host, const ArrayLike& kiva_id, const ArrayLike& path_id, const ArrayLike& first,
            const ArrayLike& points, const ArrayLike& x, const ArrayLike& y,
            const ArrayLike& released, const ArrayLike& max_speed) {
  const Ids ids("kiva_id", kiva_id);
  const Counts paths("path_id", path_id), firsts("first", first), counts("points", points),
      releases("released", released);
  const Reals xs("x", x), ys("y", y), speeds("max_speed", max_speed);
  const std::size_t rows = lengthOf(ids, paths, firsts, counts, releases);
  std::size_t total = 0;
  for (std::size_t i = 0; i < rows; ++i) total += counts[static_cast<py::ssize_t>(i)];
  for (const Reals* column : {&xs, &ys, &speeds}) {
    const auto size = static_cast<std::size_t>(column->size());
    if (size == total || (column == &speeds && size == 0)) continue;
    throw py::value_error(std::string(column->name()) + " has " + std::to_string(column->size()) +
                          " entries, and points make " + std::to_string(total));
  }
  checkSpeeds(speeds);
  const auto lock = host.use();
  for (std::size_t i = 0; i < rows; ++i) checkRobot(host, ids[static_cast<py::ssize_t>(i)]);
  for (std::size_t k = 0; k < total; ++k) {
    checkFinite("x", xs.data()[k], k);
    checkFinite("y", ys.data()[k], k);
  }
  std::size_t at = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto i = static_cast<py::ssize_t>(row);
    FollowPath path;
    path.kiva_id = ids[i];
    path.path_id = paths[i];
    path.first = firsts[i];
    path.released = releases[i];
    path.x.assign(xs.data() + at, xs.data() + at + counts[i]);
    path.y.assign(ys.data() + at, ys.data() + at + counts[i]);
    if (speeds.size() > 0) {
      path.max_speed.assign(speeds.data() + at, speeds.data() + at + counts[i]);
    }
    at += counts[i];
    host.world.post(std::move(path));
  }
}

}  // namespace

void defineCommands(py::class_<Host, HostPtr>& world) {
  world.def("post", &post, py::arg("commands"),
            R"(Posts commands: a row, or an array of shape (n,), of dtype COMMAND.

An ACCEPTED or REFUSED event answers each at the next step. TypeError for another
dtype; ValueError, and none is posted, for another shape, an unknown kind or robot, NaN or
infinity.)");
  world.def("mov", &mov, py::arg("kiva_id"), py::arg("x"), py::arg("y"),
            R"(Orders robots to (x, y) in world [m]: along x first, then along y, turning as needed.

Each argument is a number or an array of shape (n,), one command an entry; numbers go with every
entry. TypeError unless they are numbers; ValueError, and nothing is posted, for shapes that don't
match, an unknown robot, NaN or infinity. An event refuses what a robot can't do.)");
  world.def(
      "movx",
      [](Host& host, const ArrayLike& id, const ArrayLike& distance) {
        movAlong(host, Command::Kind::kMoveX, id, distance);
      },
      py::arg("kiva_id"), py::arg("distance"),
      "Orders robots to drive so far [m] along the world's x, a whole number of cells. Arguments "
      "and errors as of "
      "mov().");
  world.def(
      "movy",
      [](Host& host, const ArrayLike& id, const ArrayLike& distance) {
        movAlong(host, Command::Kind::kMoveY, id, distance);
      },
      py::arg("kiva_id"), py::arg("distance"),
      "Orders robots to drive so far [m] along the world's y, a whole number of cells. Arguments "
      "and errors as of "
      "mov().");
  world.def("rot", &rot, py::arg("kiva_id"), py::arg("direction"),
            "Orders robots to turn by 90 degrees: 1 counterclockwise, -1 clockwise. Arguments and "
            "errors as of mov().");
  world.def("lift", &lift, py::arg("kiva_id"), py::arg("status"), py::arg("shelf_id"),
            "Orders robots to carry (1) or drop (0) storage unit shelf_id; 0 drops the one that is "
            "carried. Arguments and errors as of mov().");
  world.def("follow", &follow, py::arg("kiva_id"), py::arg("path_id"), py::arg("first"),
            py::arg("points"), py::arg("x"), py::arg("y"), py::arg("released"),
            py::arg("max_speed"));
  world.def(
      "cancel", &cancel, py::arg("kiva_id"),
      R"(Ends a robot's command in DONE, "cancelled", at the next grid point where it can stop.

A lift is completed first. An event refuses it if the robot is idle. Arguments and errors as of
mov().)");
  world.def("stop", &stop, py::arg("kiva_id"), py::arg("stop") = true,
            R"(Stops wheels and lift as hard as they can; stop=False resumes what was stopped.

Kiva_id 0 means every robot. A command that comes meanwhile begins on resuming. Arguments and
errors as of mov().)");
  world.def(
      "fail", &fail, py::arg("kiva_id"), py::arg("kind"), py::arg("repair_after") = 0.0,
      R"(Causes a failure of a robot now, a FailureKind; FailureKind.REPAIRED repairs all of them.

The failure is repaired after so many seconds; 0: only by FailureKind.REPAIRED. ValueError for an
unknown robot or kind, or a time that is negative or not finite.)");
  world.def("begin_steering", &beginSteering, py::arg("kiva_id"),
            R"(Hands an idle robot over to steer(): commands along the grid are refused from now on.

ValueError, with the reason, if the robot is not idle, or can't drive.)");
  world.def("steer", &steer, py::arg("kiva_id"), py::arg("speed"), py::arg("turn_rate"),
            R"(Asks a steered robot for a speed ahead [m/s] and a turn rate to the left [rad/s].

They hold for half a second, or until the next call. The robot's accelerations are limited, and its
laser stops it before obstacles: BLOCKED. After a collision it stands until it is asked to stop.
ValueError if the robot is not steered, or a number is not finite.)");
  world.def("end_steering", &endSteering, py::arg("kiva_id"),
            R"(Gives a steered robot back to the grid.

ValueError, with what to do, unless it stands on a grid point, along the grid.)");
}

}  // namespace kiva::python
