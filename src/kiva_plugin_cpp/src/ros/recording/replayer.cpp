// SPDX-License-Identifier: Apache-2.0
#include "replayer.h"

#include <ros/console.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>

#include <stdexcept>

#include "bag_check.h"
#include "ros/messages/command_messages.h"
#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

/// Returns whether a message states how the world was after a step.
bool isReport(const rosbag::MessageInstance& message) {
  return message.getTopic() == kHashTopic || message.getTopic() == "/tf";
}

std::string checkpointIn(const rosbag::MessageInstance& message) {
  const auto keyframe = message.instantiate<std_msgs::UInt8MultiArray>();
  if (!keyframe) throw std::runtime_error("a keyframe of another type");
  return {keyframe->data.begin(), keyframe->data.end()};
}

/// Returns the command in a message, or none if it is not one.
Orders ordersIn(const rosbag::MessageInstance& message) {
  Orders out;
  forEachCommandTopic([&](auto type, const char* topic, auto toOrders) {
    if (message.getTopic() != std::string("/") + topic) return;
    const auto command = message.instantiate<typename decltype(type)::Message>();
    if (command) out = toOrders(*command);
  });
  return out;
}

}  // namespace

Replayer::Replayer(const std::string& path) : path_(path) {
  checkBag(path);
  try {
    bag_.open(path, rosbag::bagmode::Read);
    view_ = std::make_unique<rosbag::View>(bag_);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("can't replay " + path + ": " + error.what());
  }
  next_ = view_->begin();
  if (next_ == view_->end() || next_->getTopic() != kKeyframeTopic) {
    throw std::runtime_error("can't replay " + path +
                             ": it is not a recording of a world, which has " + kKeyframeTopic +
                             " first");
  }
}

void Replayer::begin(kiva::World& world) {
  try {
    world.restore(checkpointIn(*next_++));
  } catch (const std::exception& error) {
    throw std::runtime_error("can't replay " + path_ + ": " + error.what());
  }
  step_size_ = world.stepSize();
}

bool Replayer::isDue() const {
  return next_ != view_->end() && stepOf(next_->getTime(), step_size_) <= step_;
}

bool Replayer::beforeStep(kiva::World& world) {
  if (ended_) return false;
  for (; isDue(); ++next_) apply(world, *next_);
  if (next_ != view_->end()) return true;
  ended_ = true;
  ROS_INFO("%s: replayed %lu steps, and all %lu hashes are equal", path_.c_str(),
           static_cast<unsigned long>(step_), static_cast<unsigned long>(hashes_));
  end_();
  return false;
}

void Replayer::apply(kiva::World& world, const rosbag::MessageInstance& message) {
  const std::string& topic = message.getTopic();
  if (topic == kKeyframeTopic) {
    restore(world, message);
  } else if (const Orders orders = ordersIn(message); !orders.empty()) {
    for (const Order& order : orders) {
      std::visit([&world](const auto& asked) { world.post(asked); }, order);
    }
  } else if (!isReport(message)) {
    replay_(message);
  }
}

void Replayer::restore(kiva::World& world, const rosbag::MessageInstance& keyframe) {
  try {
    restore_(world, checkpointIn(keyframe));
  } catch (const std::exception& error) {
    throw std::runtime_error(path_ + ": the keyframe at step " + std::to_string(step_) +
                             " can't be restored: " + error.what());
  }
}

void Replayer::afterStep(kiva::World& world) {
  ++step_;
  for (; isDue() && isReport(*next_); ++next_) {
    const auto hash = next_->instantiate<std_msgs::String>();
    if (hash) compare(world, hash->data);
  }
}

void Replayer::compare(const kiva::World& world, const std::string& recorded) {
  const std::string now = hashText(world);
  if (now == recorded) {
    ++hashes_;
    last_equal_ = step_;
    return;
  }
  throw std::runtime_error(path_ + ": the replay differs at step " + std::to_string(step_) +
                           " and was equal at step " + std::to_string(last_equal_) +
                           ": the state is '" + now + "' where '" + recorded + "' was recorded");
}

}  // namespace kiva_ros
