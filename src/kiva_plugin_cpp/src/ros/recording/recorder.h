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

/// Writes down all that is needed to run the world again; see recording_format.h. Of a node that
/// crashes all but the last second can be read again, after `rosbag reindex`. Where the bag can't
/// be written any more the recording ends, and nothing else.
class Recorder : public StepHook {
 public:
  /// Throws std::runtime_error if there can't be a bag of that name.
  explicit Recorder(const std::string& path);

  void onCommand(const Order& order) override;
  void onChange() override { changed_ = true; }
  /// Something else takes effect at the step to come: `write` puts it into the bag.
  void onInput(std::function<void(rosbag::Bag&, const ros::Time&)> write);
  bool beforeStep(kiva::World& world) override;
  void afterStep(kiva::World& world) override;
  /// The end, after the last step.
  void finish(const kiva::World& world);

 private:
  template <typename Message>
  void write(const std::string& topic, const Message& message);
  void write(const kiva::Command& command);
  void write(const kiva::FollowPath& path);
  void writeHash(const kiva::World& world);
  /// `act(bag)`; the recording ends if that throws.
  template <typename Act>
  void attempt(Act act);
  ros::Time stamp() { return recordingStamp(step_, step_size_, index_++); }

  const std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< Null once it can't be written any more.
  WallClock::time_point saved_;  ///< When all that was written so far reached the disk's cache.
  bool is_saved_ = true;         ///< Whether that is all.
  double step_size_ = 1;
  std::uint64_t hash_every_ = 0, poses_every_ = 0;  ///< Steps.
  std::uint64_t step_ = 0;                          ///< Recorded so far.
  std::uint32_t index_ = 0;                         ///< Of the next message within this step.
  Orders commands_;
  std::vector<std::function<void(rosbag::Bag&, const ros::Time&)>> inputs_;
  bool changed_ = true;
};

}  // namespace kiva_ros
