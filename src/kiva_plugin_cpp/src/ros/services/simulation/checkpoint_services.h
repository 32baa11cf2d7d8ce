// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Checkpoint.h>
#include <warehouse_msgs/Undo.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "ros/services/simulation/checkpoint_store.h"
#include "ros/simulation/simulation_thread.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// Saves and restores the whole world: /warehouse/checkpoint, /warehouse/restore and, from a ring
/// of checkpoints, /warehouse/undo. The ring takes one before every reset and, with `autosave`, one
/// a simulated second.
class CheckpointServices : public StepHook {
 public:
  struct Options {
    bool undo = true;    ///< Whether the ring is kept.
    int autosave = 0;    ///< Checkpoints kept, one a simulated second; 0 = none.
    std::string folder;  ///< Folder of checkpoints that are files.
    std::uintmax_t most_bytes =
        0;  ///< Limit of those in memory, of the files, and of the ring, each.
  };

  /// `root` serves calls that write and read files, so it is preferably the node of a thread of its
  /// own.
  CheckpointServices(ros::NodeHandle& root, SimulationThread& simulation, const Options& options);

  void beforeReset(kiva::World& world) override;
  void afterStep(kiva::World& world) override;

 private:
  using Request = warehouse_msgs::Checkpoint::Request;
  using Response = warehouse_msgs::Checkpoint::Response;
  /// A checkpoint of the ring.
  struct Saved {
    double age;  ///< The value of `age_` when it was taken [s].
    std::string bytes;
  };

  bool save(const Request& request, Response& response);
  bool restore(const Request& request, Response& response);
  bool undo(const warehouse_msgs::Undo::Request& request, warehouse_msgs::Undo::Response& response);
  double undoHere(kiva::World& world, double seconds);
  void remember(kiva::World& world);

  SimulationThread& simulation_;
  const Options options_;
  CheckpointStore store_;

  // Used by the step thread alone.
  double age_ = 0;          ///< Simulated time less the time undone; resets don't change it [s].
  std::deque<Saved> ring_;  ///< The oldest first.
  std::uintmax_t ring_bytes_ = 0;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
