// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ros/gazebo_plugins/drives/drive.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_planar_move.so: moves a model over the floor by cmd_vel, whatever
/// its wheels do.
class PlanarMove : public Drive {
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
  double timeout_ = -1;   ///< After which a command ends [s]; negative = never.
  double commanded_ = 0;  ///< When the last command came [s].
  Schedule schedule_;
};

}  // namespace kiva_ros
