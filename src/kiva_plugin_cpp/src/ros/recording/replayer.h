// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "recording_format.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// Replays a recording and checks that the world behaves identically; see recording_format.h.
class Replayer : public StepHook {
 public:
  /// Opens the bag. Throws std::runtime_error if it can't be read or is not a recording.
  explicit Replayer(const std::string& path);
  /// Restores the world with which the recording begins; call it before the simulation starts.
  void begin(kiva::World& world);
  /// Sets the function that restores a later keyframe.
  void onKeyframe(std::function<void(kiva::World&, const std::string&)> restore) {
    restore_ = std::move(restore);
  }

  /// Sets the function that takes the messages for plugins.
  void onInput(std::function<void(const rosbag::MessageInstance&)> replay) {
    replay_ = std::move(replay);
  }

  /// Sets the function to call after a replay that was identical to its end.
  void onEnd(std::function<void()> end) { end_ = std::move(end); }

  /// Returns false when the recording has ended.
  bool beforeStep(kiva::World& world) override;
  /// Throws std::runtime_error with the step where the world deviates.
  void afterStep(kiva::World& world) override;

 private:
  bool isDue() const;  ///< Whether the next message is of this step.
  void apply(kiva::World& world, const rosbag::MessageInstance& message);
  void restore(kiva::World& world, const rosbag::MessageInstance& keyframe);
  void compare(const kiva::World& world, const std::string& recorded);

  std::function<void(kiva::World&, const std::string&)> restore_;
  std::function<void(const rosbag::MessageInstance&)> replay_;
  std::function<void()> end_ = [] {};
  const std::string path_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator next_;
  double step_size_ = 1;  ///< [s]
  std::uint64_t step_ = 0, hashes_ = 0, last_equal_ = 0;
  bool ended_ = false;
};

}  // namespace kiva_ros
