// SPDX-License-Identifier: Apache-2.0
//
// Items of one world that fell off their storage units.
#include <string>

#include "host.h"

namespace kiva::python {
namespace {

/// A row of World.fallen_items.
struct FallenRow {
  std::int32_t item_id, shelf_id;
  double x, y, z;
};

int idIn(const std::string& name, const std::string& prefix) {
  return std::stoi(name.substr(prefix.size()));
}

py::array_t<FallenRow> fallenItems(Host& host) {
  const auto lock = host.use();
  const auto all = host.world.fallenItems();
  py::array_t<FallenRow> out(static_cast<py::ssize_t>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& at = all[i].pose.Pos();
    out.mutable_data()[i] = {idIn(all[i].name, "item"), idIn(all[i].unit, "storage_unit"), at.X(),
                             at.Y(), at.Z()};
  }
  return out;
}

void pickUp(Host& host, const std::string& item) {
  const auto lock = host.use();
  host.world.pickUp(item);
}

}  // namespace

void defineFallenItems(py::class_<Host, HostPtr>& world) {
  PYBIND11_NUMPY_DTYPE(FallenRow, item_id, shelf_id, x, y, z);
  world.def_property_readonly(
      "fallen_items", &fallenItems,
      R"(The items that fell off a storage unit, (n,), in the order in which they fell: item_id, shelf_id
of that unit, x y z in world [m]. A copy.)");
  world.def("pick_up", &pickUp, py::arg("item"),
            R"(Puts an item that fell, given by its name, back on its storage unit.

ValueError if it did not fall, or its storage unit does not stand upright.)");
}

}  // namespace kiva::python
