// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Checkpoint.h>
#include <warehouse_msgs/Undo.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "checkpoint_store.h"
#include "ros/simulation/simulation_thread.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// The whole world, saved and restored: /warehouse/checkpoint, /warehouse/restore and, from a ring
/// of checkpoints, /warehouse/undo. The ring takes one before every reset and, if it is to, one a
/// simulated second.
class CheckpointServices : public StepHook {
 public:
  struct Options {
    bool undo = true;               ///< Whether there is a ring at all.
    int autosave = 0;               ///< How many of a second each it holds, 0 = none.
    std::string folder;             ///< Where checkpoints that are files lie.
    std::uintmax_t most_bytes = 0;  ///< Of those in memory, of the files, and of the ring.
  };

  /// `root`: its calls write and read files, so best one with a thread of its own.
  CheckpointServices(ros::NodeHandle& root, SimulationThread& simulation, const Options& options);

  void beforeReset(kiva::World& world) override;
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
  double undoHere(kiva::World& world, double seconds);
  void remember(kiva::World& world);

  SimulationThread& simulation_;
  const Options options_;
  CheckpointStore store_;

  // Of the step thread.
  double age_ = 0;          ///< Simulated, less what was undone; no reset of time changes it [s].
  std::deque<Saved> ring_;  ///< The oldest first.
  std::uintmax_t ring_bytes_ = 0;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
