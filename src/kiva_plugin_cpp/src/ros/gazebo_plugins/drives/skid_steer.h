// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ros/gazebo_plugins/drives/drive.h"
#include "ros/gazebo_plugins/drives/wheel_motor.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_skid_steer_drive.so: drives two wheels a side, which slide sideways
/// in turns.
class SkidSteer : public Drive {
 public:
  using Drive::Drive;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void beforeStep(kiva::World& world, double dt) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;
  std::string save() const override;
  void restore(kiva::World& world, const std::string& state) override;

 private:
  std::array<WheelMotor, 4> wheels_;          ///< Left front, right front, left rear, right rear.
  double separation_ = 0.4, radius_ = 0.075;  ///< [m]
  double torque_ = 5;                         ///< [Nm]
  bool publish_transform_ = false;
  Schedule schedule_;
};

}  // namespace kiva_ros
