// SPDX-License-Identifier: Apache-2.0
//
// A plugin to learn from: a robot that patrols between the place where it was spawned and another
// grid point. Put it into the robot's SDF, beside the plugins that it has,
//
//   <plugin name="patrol" filename="libhello_plugin.so">
//     <x>5</x>          <!-- the other end, in world [m] -->
//     <y>2</y>
//     <pause>1.5</pause>  <!-- at either end [s] -->
//   </plugin>
//
// and the folder of the library into KIVA_PLUGIN_PATH.
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/plugin.h"
#include "kiva_plugin_cpp/world.h"
#include "warehouse_layout/register_plugin.h"

namespace {

class Patrol : public kiva::Plugin {
 public:
  // Reads the parameters when the model stands. A key that is never read here is an error of the
  // SDF.
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override {
    if (world.kind(model) != kiva::ModelKind::kRobot) {
      throw kiva::DescriptionError(parameters.where() + ": patrol is for robots");
    }
    id_ = std::stoi(model.substr(4));  // kiva<id>
    const kiva::Pose home = world.state(model)->pose;
    other_end_ = {home.X(), home.Y()};
    goal_.x = parameters.number("x", home.X(), -1e5, 1e5);
    goal_.y = parameters.number("y", home.Y(), -1e5, 1e5);
    pause_ = parameters.number("pause", 1.0, 0.1, 3600);
  }

  // Commands the next place before every step of `dt` seconds.
  void beforeStep(kiva::World& world, double dt) override {
    // Ids stay with a robot; its index changes when another one is deleted.
    const int robot = world.fleet().find(id_);
    const bool idle = world.fleet().status[robot] == kiva::Status::kIdle;
    waited_ = idle ? waited_ + dt : 0;
    if (waited_ < pause_) return;
    waited_ = 0;
    // The robot turns back only from a place that it reached; a blocked or refused drive is tried
    // again.
    const kiva::Pose at = world.basePose(robot);
    if (std::hypot(at.X() - goal_.x, at.Y() - goal_.y) < 0.01) std::swap(goal_, other_end_);
    kiva::Command command;
    command.kind = kiva::Command::Kind::kMoveTo;
    command.kiva_id = id_;
    command.x = goal_.x;
    command.y = goal_.y;
    world.post(command);
  }

  // Returns the state that a checkpoint needs. The rest comes from load.
  std::string save() const override {
    std::ostringstream out;
    out.precision(17);
    out << goal_.x << ' ' << goal_.y << ' ' << other_end_.x << ' ' << other_end_.y << ' '
        << waited_;
    return out.str();
  }
  void restore(kiva::World& /*world*/, const std::string& state) override {
    std::istringstream in(state);
    in >> goal_.x >> goal_.y >> other_end_.x >> other_end_.y >> waited_;
  }

 private:
  struct Point {
    double x = 0, y = 0;  // in world [m]
  };
  int id_ = 0;
  Point goal_, other_end_;
  double pause_ = 0;   // [s]
  double waited_ = 0;  // [s]
};

}  // namespace

// Registers the class, so that a program can load it by name.
WAREHOUSE_ADD_PLUGIN(Patrol, kiva::Plugin)
