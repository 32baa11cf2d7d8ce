// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <ros/console.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "ros/messages/command_messages.h"
#include "ros/messages/convert.h"
#include "ros/messages/step_rate.h"

namespace kiva_ros {
namespace {

constexpr double kHashRate = 1;  // [Hz]
constexpr double kPoseRate = 2;  // [Hz]
constexpr auto kSaveInterval = std::chrono::seconds(1);
constexpr std::uint32_t kChunk = 768 * 1024;  // [bytes], librosbag's own

tf2_msgs::TFMessage posesOf(const kiva::World& world) {
  tf2_msgs::TFMessage out;
  out.transforms.resize(world.fleet().robots.size());
  for (int i = 0; i < world.fleet().size(); ++i) {
    geometry_msgs::TransformStamped& robot = out.transforms[i];
    robot.header = header(world.time(), "world");
    robot.child_frame_id = world.fleet().robots[i].name + "/base_link";
    robot.transform = toTransform(world.basePose(i));
  }
  return out;
}

std_msgs::String hashOf(const kiva::World& world) {
  std_msgs::String out;
  out.data = hashText(world);
  return out;
}

std_msgs::UInt8MultiArray keyframe(const std::string& checkpoint) {
  std_msgs::UInt8MultiArray out;
  out.data.assign(checkpoint.begin(), checkpoint.end());
  return out;
}

}  // namespace

Recorder::Recorder(const std::string& path) : path_(path), bag_(std::make_unique<rosbag::Bag>()) {
  try {
    bag_->open(path, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("can't record to " + path + ": " + error.what());
  }
  bag_->setCompression(rosbag::compression::LZ4);
}

void Recorder::onCommand(const Order& order) {
  if (bag_) commands_.push_back(order);
}

void Recorder::onInput(std::function<void(rosbag::Bag&, const ros::Time&)> write) {
  if (bag_) inputs_.push_back(std::move(write));
}

bool Recorder::beforeStep(kiva::World& world) {
  if (!bag_) return true;
  if (step_ == 0) {
    step_size_ = world.stepSize();
    hash_every_ = stepsPer(kHashRate, step_size_);
    poses_every_ = stepsPer(kPoseRate, step_size_);
  }
  if (changed_) {
    write(kKeyframeTopic, keyframe(world.checkpoint()));  // includes pending commands
  } else {
    for (const Order& order : commands_) {
      std::visit([this](const auto& asked) { write(asked); }, order);
    }
  }
  for (const auto& input : inputs_) {
    attempt([&](rosbag::Bag& bag) { input(bag, stamp()); });
  }
  changed_ = false;
  commands_.clear();
  inputs_.clear();
  return true;
}

void Recorder::afterStep(kiva::World& world) {
  if (!bag_) return;
  ++step_;
  index_ = 0;
  if (step_ % poses_every_ == 0) write("/tf", posesOf(world));
  const bool is_due = !is_saved_ && WallClock::now() >= saved_ + kSaveInterval;
  if (is_due || step_ % hash_every_ == 0) writeHash(world);
}

void Recorder::finish(const kiva::World& world) {
  if (step_ > 0 && step_ % hash_every_ != 0) writeHash(world);
  attempt([](rosbag::Bag& bag) { bag.close(); });
}

template <typename Act>
void Recorder::attempt(Act act) {
  if (!bag_) return;
  try {
    act(*bag_);
    is_saved_ = false;
  } catch (const rosbag::BagException& error) {
    ROS_ERROR(
        "the recording to %s ended at step %lu, the simulation goes on: %s. 'rosbag reindex %s' "
        "saves what was written",
        path_.c_str(), static_cast<unsigned long>(step_), error.what(), path_.c_str());
    // Not closed: its destructor would try to write the rest, and throw.
    bag_.release();
  }
}

/// Writes the hash. Once a second of the wall clock this closes the chunk of the bag, which until
/// then is mostly in memory, where `rosbag reindex` can't reach it.
void Recorder::writeHash(const kiva::World& world) {
  const auto now = WallClock::now();
  const bool closes = now >= saved_ + kSaveInterval;
  attempt([&](rosbag::Bag& bag) { bag.setChunkThreshold(closes ? 0 : kChunk); });  // may write
  write(kHashTopic, hashOf(world));
  if (!closes || !bag_) return;
  std::fflush(nullptr);  // librosbag does not expose its file
  saved_ = now;
  is_saved_ = true;
}

template <typename Message>
void Recorder::write(const std::string& topic, const Message& message) {
  attempt([&](rosbag::Bag& bag) { bag.write(topic, stamp(), message); });
}

void Recorder::write(const kiva::Command& command) {
  switch (command.kind) {
    case kiva::Command::Kind::kMoveTo:
      return write("/mov", toMoveTo(command));
    case kiva::Command::Kind::kMoveX:
      return write("/movx", toMoveAlong(command));
    case kiva::Command::Kind::kMoveY:
      return write("/movy", toMoveAlong(command));
    case kiva::Command::Kind::kRotate:
      return write("/rot", toRotate(command));
    case kiva::Command::Kind::kLift:
      return write("/lift", toLift(command));
    case kiva::Command::Kind::kCancel:
      return write("/cancel", toCancel(command));
    case kiva::Command::Kind::kStop:
    case kiva::Command::Kind::kGoOn:
      return write("/stop", toStop(command));
    case kiva::Command::Kind::kFollow:
      break;  // written as the path that it stands for
  }
}

void Recorder::write(const kiva::FollowPath& path) {
  if (path.max_speed.empty()) return write("/follow", toMessage(path));
  write("/follow_limited", toLimitedPath(path));
}

}  // namespace kiva_ros
