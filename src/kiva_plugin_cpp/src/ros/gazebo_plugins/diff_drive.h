// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <geometry_msgs/Twist.h>

#include <array>
#include <string>

#include "gazebo_plugin.h"

namespace kiva_ros {

/// libgazebo_ros_diff_drive.so: two wheels driven by cmd_vel, odometry and its transforms.
class DiffDrive : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void beforeStep(kiva::World& world, double dt) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;
  std::string save() const override;
  void restore(kiva::World& world, const std::string& state) override;

 private:
  enum Side { kLeft, kRight };
  struct Wheel {
    std::string joint;
    double target = 0;   ///< Speed of its rim now asked of the motor [m/s].
    double applied = 0;  ///< What the motor knows [rad/s], NaN = nothing.
  };
  struct Command {
    double speed = 0;  ///< [m/s]
    double turn = 0;   ///< [rad/s]
  };

  void readWheels(const kiva::World& world, const kiva::Parameters& parameters);
  void onCommand(const geometry_msgs::Twist& command);
  double wanted(Side side, const Command& command) const;
  void integrate(const kiva::World& world, double dt);
  kiva::EntityState odometry(const kiva::World& world) const;
  void publishOdometry(const kiva::World& world);
  void publishWheels(const kiva::World& world);

  std::array<Wheel, 2> wheels_;
  double separation_ = 0.34, radius_ = 0.075;  ///< [m]
  double acceleration_ = 0;                    ///< Of a wheel's rim [m/s²], 0 = at once.
  double torque_ = 5;                          ///< [Nm]
  double turn_sign_ = 1;                       ///< -1: the wheel called left is on the right.
  bool by_encoder_ = false;
  bool publish_odometry_ = true, publish_odometry_tf_ = true;
  bool publish_wheel_tf_ = false, publish_wheel_joints_ = false;
  std::string odometry_frame_, base_frame_;
  Schedule schedule_;
  kiva::EntityState encoder_;  ///< Odometry from the wheels' turns; the twist as the base sees it.

  Command command_;
  PluginInput<geometry_msgs::Twist> commands_;
  ros::Publisher odometry_, transforms_, joints_;
};

}  // namespace kiva_ros
