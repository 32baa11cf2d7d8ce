// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Checkpoint.h>
#include <warehouse_msgs/Undo.h>

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "ros/simulation/simulation_thread.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// The whole world, saved and restored: /warehouse/checkpoint, /warehouse/restore and, from a ring
/// of checkpoints that are taken once a simulated second, /warehouse/undo.
class CheckpointServices : public StepHook {
 public:
  /// `autosave`: how many checkpoints the ring holds, 0 = none.
  CheckpointServices(ros::NodeHandle& root, SimulationThread& simulation, int autosave);

  void afterStep(kiva::World& world) override;

 private:
  using Request = warehouse_msgs::Checkpoint::Request;
  using Response = warehouse_msgs::Checkpoint::Response;
  /// One of the ring.
  struct Saved {
    double age;  ///< As `age_` counts [s].
    std::string bytes;
  };

  bool save(Request& request, Response& response);
  bool restore(Request& request, Response& response);
  bool undo(warehouse_msgs::Undo::Request& request, warehouse_msgs::Undo::Response& response);
  std::string find(const std::string& name);
  double undoHere(kiva::World& world, double seconds);

  SimulationThread& simulation_;
  std::mutex mutex_;
  std::map<std::string, std::string> by_name_;  ///< Guarded by mutex_.

  // Of the step thread.
  const std::size_t autosave_;
  double age_ = 0;          ///< Simulated, less what was undone; no reset of time changes it [s].
  std::deque<Saved> ring_;  ///< The oldest first.
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
