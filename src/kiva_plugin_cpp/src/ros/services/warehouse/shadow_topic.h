// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/FleetState.h>

#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// Subscribes to `/warehouse/shadows`: poses, velocities and states of robots that are elsewhere.
/// Each such robot here becomes a shadow. The last message takes effect at the beginning of a step,
/// after that of `inputs`, so that a recording knows the step.
class ShadowTopic : public StepHook {
 public:
  ShadowTopic(ros::NodeHandle& root, PluginInputs& inputs);

  bool beforeStep(kiva::World& world) override;

 private:
  PluginInput<warehouse_msgs::FleetState> input_;
};

}  // namespace kiva_ros
