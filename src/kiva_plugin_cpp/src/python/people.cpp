// SPDX-License-Identifier: Apache-2.0
//
// People of one world and the zones that stop robots for them.
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>

#include "arrays.h"
#include "host.h"

namespace kiva::python {
namespace {

/// A row of World.people.
struct PersonRow {
  double x, y, yaw, vx, vy, ahead_x, ahead_y;
};

void walk(Host& host, const std::string& person, const ArrayLike& x, const ArrayLike& y,
          double speed, bool loops) {
  const Numbers<double> xs("x", x), ys("y", y);
  if (xs.size() != ys.size()) {
    throw py::value_error("x has " + std::to_string(xs.size()) + " entries and y has " +
                          std::to_string(ys.size()));
  }
  Walk walk;
  walk.loops = loops;
  for (py::ssize_t i = 0; i < xs.size(); ++i) walk.waypoints.push_back({xs[i], ys[i], speed});
  const auto lock = host.use();
  host.world.walk(person, walk);
}

py::dict people(Host& host) {
  const auto lock = host.use();
  py::dict out;
  for (const Person& p : host.world.people()) {
    const PersonRow row{p.x, p.y, p.yaw, p.vx, p.vy, p.ahead_x, p.ahead_y};
    out[py::str(p.name)] = py::array_t<PersonRow>(1, &row)[py::int_(0)];
  }
  return out;
}

void setLightCurtain(Host& host, const std::string& name,
                     const std::optional<std::array<double, 4>>& area) {
  const auto lock = host.use();
  if (area) {
    const auto& [min_x, max_x, min_y, max_y] = *area;
    host.world.setLightCurtain({name, min_x, max_x, min_y, max_y});
  } else if (!host.world.removeLightCurtain(name)) {
    throw py::key_error("there is no light curtain '" + name + "'");
  }
}

py::dict lightCurtains(Host& host) {
  const auto lock = host.use();
  py::dict out;
  for (const LightCurtain& c : host.world.lightCurtains()) {
    out[py::str(c.name)] = py::make_tuple(c.min_x, c.max_x, c.min_y, c.max_y);
  }
  return out;
}

}  // namespace

void definePeople(py::class_<Host, HostPtr>& world) {
  PYBIND11_NUMPY_DTYPE(PersonRow, x, y, yaw, vx, vy, ahead_x, ahead_y);
  world.def(
      "walk", &walk, py::arg("person"), py::arg("x") = py::tuple(), py::arg("y") = py::tuple(),
      py::arg("speed") = 1.2, py::arg("loop") = false,
      R"(Makes a person walk to places x, y in world [m], one after the other, at `speed` [m/s].

`person`: the name of an actor, or of a static model no larger than a person, which counts as one
from then on. Without places the person stays; `loop` begins with the first place again after the
last. People walk around obstacles, and never into them. ValueError, with nothing changed, for a
model that can't be a person and for places that are not finite or off the floor.)");
  world.def_property_readonly(
      "people", &people,
      R"(The people: rows by name, of x, y [m], yaw [rad], vx, vy [m/s] in world, and ahead_x, ahead_y,
the place within 3 s, straight on, that a person walks to, or will walk to after waiting.)");
  world.def(
      "set_light_curtain", &setLightCurtain, py::arg("name"), py::arg("area") = py::none(),
      R"(Sets a light curtain: robots in `area`, (min_x, max_x, min_y, max_y) [m], stand while a person
is in it.

It replaces the one of that name; None removes it. ValueError for an area that is not a rectangle,
KeyError if there is none to remove.)");
  world.def_property_readonly(
      "light_curtains", &lightCurtains,
      "The areas of the light curtains, (min_x, max_x, min_y, max_y) [m], by name.");
}

}  // namespace kiva::python
