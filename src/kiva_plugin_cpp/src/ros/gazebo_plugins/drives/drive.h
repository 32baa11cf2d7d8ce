// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <geometry_msgs/Twist.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Base of the plugins that drive a model by cmd_vel and publish its odometry.
class DrivePlugin : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  ~DrivePlugin() override;

 protected:
  static constexpr double kMost = 1e6;  ///< Largest speed and length, in SI units.

  struct DriveCommand {
    double speed = 0;  ///< Ahead [m/s].
    double aside = 0;  ///< Speed to the left [m/s].
    double turn = 0;   ///< [rad/s]
  };
  struct Covariance {
    double x = 1e-5, y = 1e-5, yaw = 1e-3;
  };

  /// Reads commandTopic, odometryTopic, odometryFrame and robotBaseFrame. Frames that another model
  /// publishes already, such as one of the same description, get this model's name as a prefix.
  void openTopics(kiva::World& world, const kiva::Parameters& parameters);
  /// Returns a frame's name with the prefixes of this model.
  std::string ownFrame(const std::string& name) const { return prefix_ + frame(name); }
  void setCovariance(const Covariance& covariance) { covariance_ = covariance; }
  /// Takes the newest message on the command topic. Returns whether there was one.
  bool takeCommand();
  void setCommand(const DriveCommand& command) { command_ = command; }
  const DriveCommand& command() const { return command_; }
  /// Returns the model's pose in world, and its planar velocity in its own frame.
  kiva::EntityState trueOdometry(const kiva::World& world) const;
  void publishOdometry(const kiva::World& world, const kiva::EntityState& state);
  void publishOdometryTransform(const kiva::World& world, const kiva::EntityState& state);
  ros::Publisher& transforms() { return transforms_; }

 private:
  void claimFrames(kiva::World& world);

  std::string prefix_;
  DriveCommand command_;
  Covariance covariance_;
  std::string odometry_frame_, base_frame_;
  PluginInput<geometry_msgs::Twist> commands_;
  ros::Publisher odometry_, transforms_;
};

}  // namespace kiva_ros
