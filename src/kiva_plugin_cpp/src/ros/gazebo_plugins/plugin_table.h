// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include "kiva_plugin_cpp/world.h"
#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/transport/publish_queue.h"

namespace kiva_ros {

/// Returns a factory of stand-ins for the plugins of gazebo_ros, by their file names. The arguments
/// must outlive the plugins.
kiva::PluginFactory pluginTable(ros::NodeHandle& root, PublishQueue& publish_queue,
                                PluginInputs& inputs);

}  // namespace kiva_ros
