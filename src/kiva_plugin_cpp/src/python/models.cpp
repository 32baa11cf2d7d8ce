// SPDX-License-Identifier: Apache-2.0
//
// Models of one world: coming and going, poses, looks.
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "host.h"
#include "kiva_plugin_cpp/look.h"

namespace kiva::python {
namespace {

/// A row of World.items.
struct ItemRow {
  std::int32_t item_id;
  double x, y, z, mass;
  std::int32_t shelf_id;
};

std::vector<std::string> spawn(Host& host, const std::vector<ModelInstance>& models) {
  std::vector<std::string> names;
  for (const ModelInstance& model : models) names.push_back(model.name);
  host.world.spawn(models);
  return names;
}

std::vector<std::string> spawnText(Host& host, const std::string& sdf, const std::string& name,
                                   const std::optional<std::array<double, 4>>& place) {
  const auto lock = host.use();
  std::vector<std::string> warnings;
  std::vector<ModelInstance> models = parseModels(sdf, host.model_paths, "<text>", &warnings);
  warn(warnings);
  if (models.size() > 1 && (!name.empty() || place)) {
    throw py::value_error("the text holds " + std::to_string(models.size()) +
                          " models; name and place are for one");
  }
  if (!name.empty()) models[0].name = name;
  if (place) {
    const auto& [x, y, z, yaw] = *place;
    models[0].pose = Pose(x, y, z, 0, 0, yaw);
  }
  return spawn(host, std::move(models));
}

void checkModel(const Host& host, const std::string& name) {
  if (!host.world.has(name)) throw py::key_error("there is no model '" + name + "'");
}

void removeModel(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  host.world.remove(name);
}

py::array_t<double> poseOf(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  const Pose pose = host.world.state(name)->pose;
  const Quaternion& q = pose.Rot();
  const double numbers[] = {pose.X(), pose.Y(), pose.Z(), q.X(), q.Y(), q.Z(), q.W()};
  return py::array_t<double>(7, numbers);
}

void setPose(Host& host, const std::string& name, double x, double y, double z, double yaw) {
  const auto lock = host.use();
  checkModel(host, name);
  host.world.setState(name, {Pose(x, y, z, 0, 0, yaw), {}});
}

/// Gives a model of one link another mass [kg]: that of the same body of another density.
void setMass(Host& host, const std::string& name, double mass) {
  const auto lock = host.use();
  checkModel(host, name);
  const auto& links = host.world.description(name)->links;
  if (links.size() != 1) throw std::invalid_argument("'" + name + "' is not a model of one link");
  Link link = links.front();
  link.principal_moments = link.principal_moments * (mass / link.mass);
  link.mass = mass;
  host.world.setLinkInertia(name, link);
}

}  // namespace

UnitRow unitRow(const World& world, int unit) {
  const StorageUnit& u = world.storageUnits()[unit];
  const Pose pose = world.storageUnitPose(unit);
  return {u.id, pose.X(), pose.Y(), pose.Z(), pose.Yaw(), u.mass, idOf(world, u.carrier)};
}

namespace {

py::array_t<UnitRow> storageUnits(Host& host) {
  const auto lock = host.use();
  const int units = static_cast<int>(host.world.storageUnits().size());
  py::array_t<UnitRow> out(units);
  for (int i = 0; i < units; ++i) out.mutable_data()[i] = unitRow(host.world, i);
  return out;
}

py::array_t<ItemRow> items(Host& host) {
  const auto lock = host.use();
  const auto& all = host.world.items();
  py::array_t<ItemRow> out(static_cast<py::ssize_t>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Pose pose = host.world.itemPose(static_cast<int>(i));
    const int unit = all[i].unit;
    out.mutable_data()[i] = {all[i].id,   pose.X(),
                             pose.Y(),    pose.Z(),
                             all[i].mass, unit < 0 ? 0 : host.world.storageUnits()[unit].id};
  }
  return out;
}

template <typename T>
py::array copyOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Returns the visuals of all links, in the model's order.
py::list visualsOf(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  py::list out;
  for (const Link& link : host.world.description(name)->links) {
    for (const Visual& visual : link.visuals) {
      const Pose pose = link.pose_in_model * visual.pose_in_link;
      const Quaternion& q = pose.Rot();
      const Vector3& size = visual.shape.size;
      out.append(py::make_tuple(
          link.name, py::make_tuple(pose.X(), pose.Y(), pose.Z(), q.X(), q.Y(), q.Z(), q.W()),
          py::make_tuple(size.X(), size.Y(), size.Z())));
    }
  }
  return out;
}

py::dict lookOfModel(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  const Look look = lookOf(*host.world.description(name));
  py::dict out;
  out["links"] = look.links;
  out["link_pose"] = copyOf(look.link_pose);
  out["shape_link"] = copyOf(look.shape_link);
  out["shape_kind"] = copyOf(look.shape_kind);
  out["shape_pose"] = copyOf(look.shape_pose);
  out["shape_size"] = copyOf(look.shape_size);
  out["shape_colour"] = copyOf(look.shape_colour);
  return out;
}

py::tuple occupancyOf(Host& host) {
  const auto lock = host.use();
  const Occupancy map = host.world.occupancy();
  py::array_t<std::uint8_t> cells({map.rows, map.columns}, map.cells.data());
  return py::make_tuple(map.x, map.y, map.spacing, cells);
}

}  // namespace

void defineModels(py::class_<Host, HostPtr>& world) {
  PYBIND11_NUMPY_DTYPE(UnitRow, shelf_id, x, y, z, yaw, mass, kiva_id);
  PYBIND11_NUMPY_DTYPE(ItemRow, item_id, x, y, z, mass, shelf_id);
  world.def("spawn", &spawnText, py::arg("sdf"), py::arg("name") = "",
            py::arg("place") = py::none(),
            R"(Adds all models of an SDF or URDF text, or none of them, and returns their names.

A single one can be given a name and a place, (x, y, z, yaw) in world [m, rad]. DescriptionError
(a ValueError) names what is wrong.)");
  world.def("delete", &removeModel, py::arg("name"),
            "Removes a model; a storage unit goes with its items. KeyError if no model has that "
            "name.");
  world.def("pose", &poseOf, py::arg("name"),
            "Returns x y z qx qy qz qw of a model in world [m], (7,) float64. KeyError if there is "
            "none.");
  world.def("visuals", &visualsOf, py::arg("name"),
            R"(Returns the visuals of a model: a list of (link, pose in the model, size).

The pose is x y z [m] qx qy qz qw, the size a box's edges [m] (0 of other shapes). KeyError if no
model has that name.)");
  world.def(
      "look", &lookOfModel, py::arg("name"),
      R"(Returns the look of a model as a dict of arrays, with the names and the layout of the fields of
warehouse_msgs/Look. KeyError if no model has that name.)");
  world.def("occupancy", &occupancyOf,
            R"(Returns the obstacles on the floor as a grid: (x, y, spacing, cells).

cells: (rows along y, columns along x) uint8, 0 free, 50 a storage unit, 99 a belt, 100 taken by
anything else, or no floor; robots are left out. (x, y) is the centre of cells[0, 0], spacing the
edge of a cell, in world [m].)");
  world.def("set_pose", &setPose, py::arg("name"), py::arg("x"), py::arg("y"), py::arg("z") = 0.0,
            py::arg("yaw") = 0.0,
            R"(Puts a model at a place in world [m, rad], at rest; a command of it ends in BLOCKED.

KeyError if no model has that name, DescriptionError if the place is not finite.)");
  world.def(
      "set_mass", &setMass, py::arg("name"), py::arg("mass"),
      R"(Gives a model of one link another mass [kg], as a body of the same shape and another density.

A unit weighs what its items do. KeyError if no model has that name, ValueError for another model or
a mass that is not above 0.)");
  world.def_property_readonly(
      "storage_units", &storageUnits,
      R"(The storage units, (n,): shelf_id, x y z yaw in world [m, rad], mass with items [kg], kiva_id of
the carrier (0 = none). A copy.)");
  world.def_property_readonly(
      "items", &items,
      "The items, (n,): item_id, x y z in world [m], mass [kg], shelf_id of the unit below (0 = "
      "none). A copy.");
  world.def_property_readonly("names", guarded([](World& w) { return w.modelNames(); }),
                              "The names of all models, in the order in which they were added.");
}

}  // namespace kiva::python
