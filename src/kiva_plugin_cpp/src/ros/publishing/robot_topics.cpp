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

template <typename Message>
ros::Publisher RobotTopics::advertise(int kiva_id, const char* topic,
                                      SubscriberCounts::RobotTopic kind, int queue_size,
                                      bool latched) {
  const auto count = [this, kind, kiva_id](int change) {
    subscribers_.count(kind, kiva_id, change);
  };
  const std::string name = "/kiva" + std::to_string(kiva_id) + "/" + topic;
  return advertiseCounted<Message>(node_, name, queue_size, count, latched);
}

RobotTopics::Topics RobotTopics::advertise(const RobotInfo& robot) {
  using Kind = SubscriberCounts::RobotTopic;
  Topics out;
  out.laser = robot.laser;
  out.status = BulkPublisher(
      advertise<warehouse_msgs::KivaStatus>(robot.id, "status", Kind::kStatus, kStatusQueue, true));
  out.odometry =
      BulkPublisher(advertise<nav_msgs::Odometry>(robot.id, "odom", Kind::kOdometry, kStreamQueue));
  if (!robot.laser.fitted) return out;
  out.scan = BulkPublisher(
      advertise<sensor_msgs::LaserScan>(robot.id, "chassis/laser/scan", Kind::kScan, kStreamQueue));
  return out;
}

void RobotTopics::publish(const kiva::StatusChange& status) {
  const auto at = robots_.find(status.kiva_id);
  if (at != robots_.end()) at->second.status.publisher().publish(toMessage(status));
}

void RobotTopics::publishHeartbeat(const kiva::StatusChange& status) {
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
