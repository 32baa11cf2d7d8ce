// SPDX-License-Identifier: Apache-2.0
//
// The robots of one world as arrays, with laser scans and radio reports.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "arrays.h"
#include "host.h"

namespace kiva::python {
namespace {

/// The robots of a world: World.fleet in Python.
struct FleetView {
  HostPtr host;

  template <typename Out, typename Read>
  py::array_t<Out> column(Read read) const {
    const auto lock = host->use();
    return view<Out>(read(host->world.fleet()));
  }
  template <typename Read>
  py::array_t<std::int32_t> numbers(Read read) const {
    const auto lock = host->use();
    const int size = host->world.fleet().size();
    py::array_t<std::int32_t> out(size);
    for (int i = 0; i < size; ++i) out.mutable_data()[i] = read(host->world, i);
    return out;
  }
};

std::int32_t shelfOf(const World& world, int robot) {
  const int unit = world.fleet().unit[robot];
  return unit < 0 ? 0 : world.storageUnits()[unit].id;
}

int indexOf(const Host& host, std::int32_t kiva_id) {
  checkRobot(host, kiva_id);
  return host.world.fleet().find(kiva_id);
}

std::vector<int> robotsOf(const Host& host, const ArrayLike& kiva_id) {
  std::vector<int> robots;
  if (kiva_id.is_none()) {
    for (int i = 0; i < host.world.fleet().size(); ++i) robots.push_back(i);
    return robots;
  }
  const Numbers<std::int32_t> ids("kiva_id", kiva_id);
  for (py::ssize_t i = 0; i < ids.size(); ++i) robots.push_back(indexOf(host, ids[i]));
  return robots;
}

/// Writes scans into host.ranges: one row a robot, padded with NaN.
void scanInto(Host& host, const std::vector<int>& robots, std::size_t rays) {
  std::vector<int> fitted;
  for (int robot : robots) {
    if (host.world.fleet().robots[robot].laser.fitted) fitted.push_back(robot);
  }
  std::vector<std::vector<float>> ranges;
  host.world.scan(fitted, &ranges);
  std::fill(host.ranges.begin(), host.ranges.end(), std::numeric_limits<float>::quiet_NaN());
  std::size_t next = 0;  // index in `fitted`
  for (std::size_t row = 0; row < robots.size() && next < fitted.size(); ++row) {
    if (robots[row] != fitted[next]) continue;
    std::copy(ranges[next].begin(), ranges[next].end(), host.ranges.data() + row * rays);
    ++next;
  }
}

py::array_t<float> scans(Host& host, const ArrayLike& kiva_id) {
  const auto lock = host.use();
  const std::vector<int> robots = robotsOf(host, kiva_id);
  std::size_t rays = 0;
  for (int robot : robots) {
    const LaserParameters& laser = host.world.fleet().robots[robot].laser;
    if (laser.fitted) rays = std::max(rays, static_cast<std::size_t>(laser.rays));
  }
  if (host.ranges.size() != robots.size() * rays) {
    host.ranges = Column<float>(robots.size() * rays);
  }
  {
    py::gil_scoped_release release;
    scanInto(host, robots, rays);
  }
  return view<float>(host.ranges,
                     {static_cast<py::ssize_t>(robots.size()), static_cast<py::ssize_t>(rays)});
}

/// A row of Fleet.lasers.
struct LaserRow {
  std::int32_t rays;
  double min_angle, max_angle, min_range, max_range, rate, x, z;
};

py::array_t<LaserRow> lasers(const FleetView& view) {
  const auto lock = view.host->use();
  std::vector<LaserRow> rows;
  for (const Robot& robot : view.host->world.fleet().robots) {
    const LaserParameters& of = robot.laser;
    rows.push_back({of.fitted ? of.rays : 0, of.min_angle, of.max_angle, of.min_range, of.max_range,
                    of.rate, of.x, of.z});
  }
  return py::array_t<LaserRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

/// A row of World.last_heard.
struct HeardRow {
  std::int32_t index;
  double x, y, yaw, vx, vy, yaw_rate;
  std::uint8_t status, state;
  std::int32_t shelf_id;
  std::uint32_t path_id, reached, left;
  std::uint8_t last_end;
};

py::array_t<HeardRow> lastHeard(Host& host) {
  const auto lock = host.use();
  std::vector<HeardRow> rows;
  for (int i = 0; i < host.world.fleet().size(); ++i) {
    const auto last = host.world.lastHeard(i);
    if (!last) continue;
    rows.push_back({i, last->x, last->y, last->yaw, last->vx, last->vy, last->yaw_rate,
                    static_cast<std::uint8_t>(last->status), static_cast<std::uint8_t>(last->state),
                    last->shelf_id, last->path_id, last->reached, last->left, last->last_end});
  }
  return py::array_t<HeardRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

}  // namespace

std::int32_t idOf(const World& world, int robot) {
  return robot < 0 ? 0 : world.fleet().robots[robot].id;
}

void defineFleet(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(LaserRow, rays, min_angle, max_angle, min_range, max_range, rate, x, z);
  py::class_<FleetView> fleet(m, "Fleet", R"(All robots as arrays: entry i of each is robot i.

Arrays but kiva_id and shelf_id are read-only views: nothing is copied, and step() changes what
they show. They are current until robots come or go, or the world is restored: read the property
again then. An old array stays safe to read, whatever becomes of the world, with its last values.)");
  const auto add = [&fleet](const char* name, auto read, auto zero, const char* doc) {
    const auto get = [read](const FleetView& f) { return f.template column<decltype(zero)>(read); };
    fleet.def_property_readonly(name, get, doc);
  };
  add(
      "x", [](const Fleet& f) -> auto& { return f.x; }, 0.0,
      "(n,) float64: x in world [m]. A view.");
  add(
      "y", [](const Fleet& f) -> auto& { return f.y; }, 0.0,
      "(n,) float64: y in world [m]. A view.");
  add(
      "yaw", [](const Fleet& f) -> auto& { return f.yaw; }, 0.0,
      "(n,) float64: heading in world [rad], unwrapped: it counts full turns. A view.");
  add(
      "vx", [](const Fleet& f) -> auto& { return f.vx; }, 0.0,
      "(n,) float64: velocity along the world's x [m/s]. A view.");
  add(
      "vy", [](const Fleet& f) -> auto& { return f.vy; }, 0.0,
      "(n,) float64: velocity along the world's y [m/s]. A view.");
  add(
      "yaw_rate", [](const Fleet& f) -> auto& { return f.yaw_rate; }, 0.0,
      "(n,) float64 [rad/s], counterclockwise. A view.");
  add(
      "left_wheel_speed", [](const Fleet& f) -> auto& { return f.wheel_speed[0]; }, 0.0,
      "(n,) float64 [rad/s]. A view.");
  add(
      "right_wheel_speed", [](const Fleet& f) -> auto& { return f.wheel_speed[1]; }, 0.0,
      "(n,) float64 [rad/s]. A view.");
  add(
      "tower", [](const Fleet& f) -> auto& { return f.tower; }, 0.0,
      "(n,) float64: height of the tower above its rest [m]. A view.");
  add(
      "status", [](const Fleet& f) -> auto& { return f.status; }, std::uint8_t(),
      "(n,) uint8, values of Status. A view.");
  add(
      "state", [](const Fleet& f) -> auto& { return f.state; }, std::uint8_t(),
      "(n,) uint8, values of State. A view.");
  add(
      "last_end", [](const Fleet& f) -> auto& { return f.last_end; }, std::uint8_t(),
      "(n,) uint8: how a robot's last command ended, until the next is accepted: 0 none yet, else "
      "EventKind.DONE or BLOCKED. A view.");
  add(
      "path_id", [](const Fleet& f) -> auto& { return f.path_id; }, std::uint32_t(),
      "(n,) uint32: the path_id of a robot's last command; 0 if that is not a path. A view.");
  add(
      "reached", [](const Fleet& f) -> auto& { return f.reached; }, std::uint32_t(),
      "(n,) uint32: how many points of its path a robot's centre has reached, the first one, "
      "where it began, among them. A view.");
  add(
      "left", [](const Fleet& f) -> auto& { return f.left; }, std::uint32_t(),
      "(n,) uint32: how many leading cells of its path a robot and its load have left wholly. A "
      "view.");
  add(
      "stopped", [](const Fleet& f) -> auto& { return f.stopped; }, std::uint8_t(),
      "(n,) uint8: 1 while stop() holds a robot. A view.");
  add(
      "failures", [](const Fleet& f) -> auto& { return f.failures; }, std::uint8_t(),
      "(n,) uint8: the failures of a robot as bits, 1 << each FailureKind, and 1 for "
      "an empty battery; 0 = none. A view.");
  add(
      "allowed_speed", [](const Fleet& f) -> auto& { return f.allowed_speed; }, 0.0,
      "(n,) float64: speed that its protective field allows a robot [m/s]; 0 = it stands because "
      "of "
      "people, inf = no person is near. A view.");
  add(
      "curtained", [](const Fleet& f) -> auto& { return f.curtained; }, std::uint8_t(),
      "(n,) uint8: 1 while a robot stands in a light curtain with a person in it. A view.");
  add(
      "charge", [](const Fleet& f) -> auto& { return f.charge; }, 0.0f,
      "(n,) float32: state of charge of the battery, 0 to 1; 1 where realism has no energy. A "
      "view.");
  fleet.def_property_readonly(
      "kiva_id", [](const FleetView& f) { return f.numbers(idOf); },
      "(n,) int32: the robots' numbers; kiva7 has 7. A copy.");
  fleet.def_property_readonly(
      "shelf_id", [](const FleetView& f) { return f.numbers(shelfOf); },
      "(n,) int32: number of the storage unit that each robot carries, 0 = none. A copy.");
  fleet.def_property_readonly(
      "believed",
      [](const FleetView& f) {
        const auto lock = f.host->use();
        const int size = f.host->world.fleet().size();
        py::array_t<double> out({size, 3});
        for (int i = 0; i < size; ++i) {
          const Vector3 at = f.host->world.believedPose(i);
          for (int k = 0; k < 3; ++k) out.mutable_at(i, k) = at[k];
        }
        return out;
      },
      "(n, 3) float64: x, y [m], yaw [rad] that each robot estimates by itself. A copy.");
  fleet.def_property_readonly(
      "lasers", &lasers,
      R"((n,) array of what each robot's laser is like, with fields rays (0 = it has none),
min_angle, max_angle [rad] (0 = ahead, counterclockwise), min_range, max_range [m], rate [Hz], and
x, z [m], where it sits on the chassis and above the floor. A copy.)");
  fleet.def(
      "index",
      [](const FleetView& f, std::int32_t id) {
        const auto lock = f.host->use();
        return indexOf(*f.host, id);
      },
      py::arg("kiva_id"),
      "Returns the index of robot kiva_id in the arrays. ValueError if there is none.");
  fleet.def("__len__", [](const FleetView& f) {
    const auto lock = f.host->use();
    return f.host->world.fleet().size();
  });
}

void defineRobots(py::class_<Host, HostPtr>& world) {
  PYBIND11_NUMPY_DTYPE(HeardRow, index, x, y, yaw, vx, vy, yaw_rate, status, state, shelf_id,
                       path_id, reached, left, last_end);
  world.def_property_readonly(
      "fleet", [](const HostPtr& host) { return FleetView{host}; },
      "The robots as arrays, a Fleet.");
  world.def(
      "last_heard", &lastHeard,
      R"(Returns the last report received of robots whose radio is lost, and of every robot where
reports go by radio: (n,), with fields index (in the fleet's arrays) and those of Fleet. A copy.)");
  world.def(
      "scans", &scans, py::arg("kiva_id") = py::none(),
      R"(Returns laser ranges of all robots, or of those given: (n, rays) float32 [m], a row a robot.

+inf = nothing within range, -inf = nearer than the minimum; rays go counterclockwise; NaN fills
the rows of robots with fewer rays or without a laser. A read-only view of the world's own memory:
current until the next call of scans(), which may write into it; safe to read ever after.
ValueError for an unknown robot.)");
}

}  // namespace kiva::python
