// SPDX-License-Identifier: Apache-2.0
#include "plugin_table.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "lacking.h"
#include "ros/gazebo_plugins/drives/diff_drive.h"
#include "ros/gazebo_plugins/drives/force.h"
#include "ros/gazebo_plugins/drives/planar_move.h"
#include "ros/gazebo_plugins/drives/skid_steer.h"
#include "ros/gazebo_plugins/rays/block_laser.h"
#include "ros/gazebo_plugins/rays/depth_camera.h"
#include "ros/gazebo_plugins/rays/laser.h"
#include "ros/gazebo_plugins/rays/range.h"
#include "ros/gazebo_plugins/rays/velodyne_laser.h"
#include "ros/gazebo_plugins/sensors/bumper.h"
#include "ros/gazebo_plugins/sensors/ft_sensor.h"
#include "ros/gazebo_plugins/sensors/hector_imu.h"
#include "ros/gazebo_plugins/sensors/imu.h"
#include "ros/gazebo_plugins/sensors/imu_sensor.h"
#include "ros/gazebo_plugins/sensors/joint_states.h"
#include "ros/gazebo_plugins/sensors/p3d.h"

// To add one: a class derived from GazeboPlugin in files of its own, whose load() calls enter(),
// reads every parameter that the plugin of gazebo_ros has (skip() those without a use here) and
// throws kiva::DescriptionError where one is faulty, which leaves the plugin out with a warning;
// a line below; a row in doc/reference/gazebo.md. force.cpp is the smallest that acts, p3d.cpp one
// that measures. What it remembers that decides what its model does belongs in save() and
// restore().

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
  std::map<std::string, Make> table = {
      {"libgazebo_ros_block_laser.so", maker<BlockLaser>()},
      {"libgazebo_ros_bumper.so", maker<Bumper>()},
      {"libgazebo_ros_depth_camera.so", maker<DepthCamera>()},
      {"libgazebo_ros_diff_drive.so", maker<DiffDrive>()},
      {"libgazebo_ros_force.so", maker<Force>()},
      {"libgazebo_ros_ft_sensor.so", maker<FtSensor>()},
      {"libgazebo_ros_gpu_laser.so", maker<Laser>()},
      {"libgazebo_ros_imu.so", maker<Imu>()},
      {"libgazebo_ros_imu_sensor.so", maker<ImuSensor>()},
      {"libgazebo_ros_joint_state_publisher.so", maker<JointStates>()},
      {"libgazebo_ros_laser.so", maker<Laser>()},
      {"libgazebo_ros_openni_kinect.so", maker<OpenniKinect>()},
      {"libgazebo_ros_p3d.so", maker<P3d>()},
      {"libgazebo_ros_planar_move.so", maker<PlanarMove>()},
      {"libgazebo_ros_range.so", maker<Range>()},
      {"libgazebo_ros_skid_steer_drive.so", maker<SkidSteer>()},
      {"libgazebo_ros_velodyne_gpu_laser.so", maker<VelodyneLaser>()},
      {"libgazebo_ros_velodyne_laser.so", maker<VelodyneLaser>()},
      {"libhector_gazebo_ros_imu.so", maker<HectorImu>()},
  };
  for (const auto& [filename, advice] : lackingPlugins()) {
    table[filename] = [advice = advice](const PluginContext& context) {
      return std::make_shared<Lacking>(context, advice);
    };
  }
  const auto frames = std::make_shared<FrameOwners>();
  return [=, &root, &publish_queue, &inputs](const std::string& filename,
                                             const kiva::SensorDescription* sensor) {
    const auto entry = table.find(filename);
    const PluginContext context{root, publish_queue, inputs, frames, sensor};
    return entry == table.end() ? nullptr : entry->second(context);
  };
}

}  // namespace kiva_ros
