// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rosbag/bag.h>

#include <string>
#include <vector>

#include "recording_format.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// Writes down all that is needed to run the world again; see recording.h.
class Recorder : public StepHook {
 public:
  /// Throws std::runtime_error if there can't be a bag of that name.
  explicit Recorder(const std::string& path);

  void onCommand(const kiva::Command& command) override { commands_.push_back(command); }
  void onCheckpoint() override { checkpointed_ = true; }
  void onChange() override { changed_ = true; }
  bool beforeStep(kiva::World& world) override;
  void afterStep(kiva::World& world) override;
  /// The end, after the last step.
  void finish(const kiva::World& world);

 private:
  template <typename Message>
  void write(const std::string& topic, const Message& message);
  void write(const kiva::Command& command);

  rosbag::Bag bag_;
  double step_size_ = 1;
  std::uint64_t hash_every_ = 0, poses_every_ = 0;  ///< Steps.
  std::uint64_t step_ = 0;                          ///< Recorded so far.
  std::uint32_t index_ = 0;                         ///< Of the next message within this step.
  std::vector<kiva::Command> commands_;
  bool changed_ = true, checkpointed_ = false;
};

}  // namespace kiva_ros
