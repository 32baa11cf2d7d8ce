// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "recording_format.h"
#include "ros/simulation/step_hook.h"
#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// Records everything needed to run the world again; see recording_format.h. After a crash of the
/// node, all but the last second can be read after `rosbag reindex`. A failed write ends the
/// recording alone.
class Recorder : public StepHook {
 public:
  /// Opens the bag. Throws std::runtime_error if it can't be created.
  explicit Recorder(const std::string& path);

  void onCommand(const Order& order) override;
  void onChange() override { changed_ = true; }
  /// Records another input of the next step: `write` puts it into the bag.
  void onInput(std::function<void(rosbag::Bag&, const ros::Time&)> write);
  bool beforeStep(kiva::World& world) override;
  void afterStep(kiva::World& world) override;
  /// Ends the recording, after the last step.
  void finish(const kiva::World& world);

 private:
  template <typename Message>
  void write(const std::string& topic, const Message& message);
  void write(const kiva::Command& command);
  void write(const kiva::FollowPath& path);
  void writeHash(const kiva::World& world);
  /// Calls `act(bag)`; the recording ends if it throws.
  template <typename Act>
  void attempt(Act act);
  ros::Time stamp() { return recordingStamp(step_, step_size_, index_++); }

  const std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< Null after a failed write.
  WallClock::time_point saved_;       ///< When the file was flushed last.
  bool is_saved_ = true;              ///< Whether everything written is flushed.
  double step_size_ = 1;
  std::uint64_t hash_every_ = 0, poses_every_ = 0;  ///< Steps.
  std::uint64_t step_ = 0;                          ///< Steps recorded so far.
  std::uint32_t index_ = 0;                         ///< Index of the next message within this step.
  Orders commands_;
  std::vector<std::function<void(rosbag::Bag&, const ros::Time&)>> inputs_;
  bool changed_ = true;
};

}  // namespace kiva_ros
