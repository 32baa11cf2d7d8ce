// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ros/gazebo_plugins/drives/drive.h"
#include "ros/gazebo_plugins/drives/wheel_motor.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_diff_drive.so: drives two wheels by cmd_vel, publishes odometry and
/// its transforms.
class DiffDrive : public DrivePlugin {
 public:
  using DrivePlugin::DrivePlugin;
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
    WheelMotor motor;
    double target = 0;  ///< Commanded speed of its rim [m/s].
  };

  void readWheels(const kiva::World& world, const kiva::Parameters& parameters);
  double desiredSpeed(Side side) const;
  void integrate(const kiva::World& world, double dt);
  void publishWheels(const kiva::World& world);

  std::array<Wheel, 2> wheels_;
  double separation_ = 0.34, radius_ = 0.075;  ///< [m]
  double acceleration_ = 0;  ///< Acceleration of a wheel's rim [m/s²], 0 = at once.
  double torque_ = 5;        ///< [Nm]
  double turn_sign_ = 1;     ///< -1: the wheel called left is on the right.
  bool by_encoder_ = false;
  bool publish_odometry_ = true, publish_odometry_tf_ = true;
  bool publish_wheel_tf_ = false, publish_wheel_joints_ = false;
  Schedule schedule_;
  kiva::EntityState encoder_;  ///< Odometry from the wheels' turns; the twist in the base's frame.
  ros::Publisher joints_;
};

}  // namespace kiva_ros
