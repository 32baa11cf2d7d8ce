// SPDX-License-Identifier: Apache-2.0
#include "plugin_table.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "bumper.h"
#include "diff_drive.h"
#include "imu.h"
#include "joint_states.h"
#include "laser.h"

namespace kiva_ros {
namespace {

using Make = std::function<std::shared_ptr<kiva::Plugin>(const PluginContext&)>;

template <typename Plugin>
Make maker() {
  return [](const PluginContext& context) { return std::make_shared<Plugin>(context); };
}

}  // namespace

kiva::PluginFactory pluginTable(ros::NodeHandle& root, PublishQueue& publish_queue,
                                PluginInputs& inputs) {
  const std::map<std::string, Make> table = {
      {"libgazebo_ros_diff_drive.so", maker<DiffDrive>()},
      {"libgazebo_ros_laser.so", maker<Laser>()},
      {"libgazebo_ros_gpu_laser.so", maker<Laser>()},
      {"libgazebo_ros_imu.so", maker<Imu>()},
      {"libgazebo_ros_bumper.so", maker<Bumper>()},
      {"libgazebo_ros_joint_state_publisher.so", maker<JointStates>()},
  };
  return [=, &root, &publish_queue, &inputs](const std::string& filename,
                                             const kiva::SensorDescription* sensor) {
    const auto found = table.find(filename);
    const PluginContext context{root, publish_queue, inputs, sensor};
    return found == table.end() ? nullptr : found->second(context);
  };
}

}  // namespace kiva_ros
