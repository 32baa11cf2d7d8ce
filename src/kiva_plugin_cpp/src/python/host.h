// SPDX-License-Identifier: Apache-2.0
//
// Shared by the bindings of one world and of many.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"

namespace kiva::python {

namespace py = pybind11;

/// Number of steps between checks for Ctrl-C.
constexpr std::int64_t kStepsBetweenSignals = 256;

/// A row of World.storage_units.
struct UnitRow {
  std::int32_t shelf_id;
  double x, y, z, yaw, mass;
  std::int32_t kiva_id;
};

/// A world that one thread uses at a time: use() throws in a second one.
class Host {
 public:
  Host(const WorldDescription& description, const WorldOptions& options, ModelPaths paths)
      : world(description, options), model_paths(std::move(paths)) {}

  std::unique_lock<std::mutex> use() {
    std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the world is in use by another thread");
    return lock;
  }

  World world;
  ModelPaths model_paths;
  Column<float> ranges;  // result of the last scans()

 private:
  std::mutex mutex_;
};

using HostPtr = std::shared_ptr<Host>;

/// Returns a function of the world as a method that throws while another thread uses the world.
template <typename Call>
auto guarded(Call call) {
  return [call](Host& host) {
    const auto lock = host.use();
    return call(host.world);
  };
}

/// Issues each text as a UserWarning of Python.
void warn(const std::vector<std::string>& warnings);

/// Throws ValueError unless there is a robot of that number.
void checkRobot(const Host& host, std::int32_t id);
/// Returns the number of the robot at that index of the fleet's arrays, 0 for -1.
std::int32_t idOf(const World& world, int robot);
/// Throws ValueError, with the index `i` of the command, unless the world can take the command.
void checkCommand(const Host& host, const Command& command, std::size_t i);
/// Returns an array of dtype COMMAND as rows. Throws TypeError for another dtype and ValueError for
/// another shape.
py::array_t<Command, py::array::c_style> commandRows(const py::array& commands);
UnitRow unitRow(const World& world, int unit);

// Each adds its part to the module or to the class World.
void defineFleet(py::module_& m);
void defineWorld(py::module_& m);
void defineCommands(py::class_<Host, HostPtr>& world);
void defineRobots(py::class_<Host, HostPtr>& world);
void defineModels(py::class_<Host, HostPtr>& world);
void definePeople(py::class_<Host, HostPtr>& world);
void defineFallenItems(py::class_<Host, HostPtr>& world);
void defineWorlds(py::module_& m);

}  // namespace kiva::python
