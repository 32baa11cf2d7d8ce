// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <geometry_msgs/Wrench.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_force.so: applies the last wrench of a topic to a link, in world,
/// until the next one.
class Force : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void beforeStep(kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;
  std::string save() const override;
  void restore(kiva::World& world, const std::string& state) override;

 private:
  std::string link_;
  kiva::Vector3 force_, torque_;  ///< [N, Nm]
  PluginInput<geometry_msgs::Wrench> wrenches_;
};

}  // namespace kiva_ros
