// SPDX-License-Identifier: Apache-2.0
#include "robot_topics.h"

#include <set>
#include <string>
#include <utility>

#include "ros/messages/convert.h"
#include "warehouse_messages.h"

namespace kiva_ros {
namespace {

constexpr int kStatusQueue = 100;

}  // namespace

void RobotTopics::update(const RobotInfos& robots) {
  std::set<int> ids;
  for (const RobotInfo& robot : robots) {
    ids.insert(robot.id);
    const auto at = robots_.find(robot.id);
    if (at == robots_.end()) {
      robots_.emplace(robot.id, advertise(robot));
    } else {
      at->second.laser = robot.laser;
    }
  }
  for (auto at = robots_.begin(); at != robots_.end();) {
    if (ids.count(at->first)) {
      ++at;
      continue;
    }
    const int id = at->first;
    at = robots_.erase(at);
    subscribers_.forget(id);
  }
}

std::function<void(int)> RobotTopics::counter(SubscriberCounts::RobotTopic topic, int kiva_id) {
  return [this, topic, kiva_id](int change) { subscribers_.count(topic, kiva_id, change); };
}

RobotTopics::Topics RobotTopics::advertise(const RobotInfo& robot) {
  using Kind = SubscriberCounts::RobotTopic;
  const std::string name = "kiva" + std::to_string(robot.id);
  Topics out;
  out.laser = robot.laser;
  out.status = LatchedPublisher<warehouse_msgs::KivaStatus>(node_, name + "/status", kStatusQueue,
                                                            counter(Kind::kStatus, robot.id));
  out.odometry = DirectPublisher(advertiseCounted<nav_msgs::Odometry>(
      node_, name + "/odom", kStreamQueue, counter(Kind::kOdometry, robot.id)));
  if (!robot.laser.fitted) return out;
  out.scan = DirectPublisher(advertiseCounted<sensor_msgs::LaserScan>(
      node_, name + "/chassis/laser/scan", kStreamQueue, counter(Kind::kScan, robot.id)));
  return out;
}

void RobotTopics::publish(const kiva::StatusChange& status) {
  const auto at = robots_.find(status.kiva_id);
  if (at != robots_.end()) at->second.status.publish(toMessage(status));
}

void RobotTopics::publish(const Scan& scan, double time) {
  const auto at = robots_.find(scan.kiva_id);
  if (at == robots_.end() || !at->second.laser.fitted) return;
  at->second.scan.publish(toMessage(scan, at->second.laser, time));
}

void RobotTopics::publishOdometry(const RobotPose& robot, double time) {
  const auto at = robots_.find(robot.kiva_id);
  if (at == robots_.end()) return;
  at->second.odometry.publish(toMessage(robot, time));
}

}  // namespace kiva_ros
