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

/// Runs a recording again and checks that the world goes the same way; see recording_format.h.
class Replayer : public StepHook {
 public:
  /// Throws std::runtime_error if the bag can't be read or is no recording.
  explicit Replayer(const std::string& path);
  /// Makes the world the one with which the recording begins; before the simulation starts.
  void begin(kiva::World& world);
  /// How the simulation goes to a later keyframe.
  void onKeyframe(std::function<void(kiva::World&, const std::string&)> restore) {
    restore_ = std::move(restore);
  }

  /// What takes all messages that are none of the recording's own.
  void onInput(std::function<void(const rosbag::MessageInstance&)> replay) {
    replay_ = std::move(replay);
  }

  /// What follows once it has ended, and was the same all along.
  void onEnd(std::function<void()> end) { end_ = std::move(end); }

  /// False when the recording has ended.
  bool beforeStep(kiva::World& world) override;
  /// Throws std::runtime_error, which names the step, where the world goes another way.
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
