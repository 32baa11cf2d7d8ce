// SPDX-License-Identifier: Apache-2.0
#include "robot_topics.h"

#include <set>
#include <string>
#include <utility>

#include "convert.h"

namespace kiva_ros {
namespace {

constexpr int kStatusQueue = 100;
constexpr int kStreamQueue = 10;

}  // namespace

void RobotTopics::update(const Roster& roster) {
  std::set<int> ids;
  for (const RosterEntry& robot : roster) {
    ids.insert(robot.id);
    const auto [at, is_new] = robots_.try_emplace(robot.id);
    if (is_new) at->second = advertise(robot);
    if (at->second.laser.fitted != robot.laser.fitted) advertiseScan(robot, &at->second);
    at->second.laser = robot.laser;
  }
  for (auto at = robots_.begin(); at != robots_.end();) {
    if (ids.count(at->first)) {
      ++at;
      continue;
    }
    const int id = at->first;
    at = robots_.erase(at);
    audience_.forget(id);
  }
}

RobotTopics::Topics RobotTopics::advertise(const RosterEntry& robot) {
  const std::string prefix = "/kiva" + std::to_string(robot.id);
  Topics out;
  out.laser = robot.laser;
  out.status = node_.advertise<warehouse_msgs::KivaStatus>(prefix + "/status", kStatusQueue, true);
  out.odometry = advertiseCounted<nav_msgs::Odometry>(
      node_, prefix + "/odom", kStreamQueue, [this, id = robot.id](int change) {
        audience_.count(Audience::RobotTopic::kOdometry, id, change);
      });
  advertiseScan(robot, &out);
  return out;
}

void RobotTopics::advertiseScan(const RosterEntry& robot, Topics* topics) {
  topics->scan.shutdown();
  if (!robot.laser.fitted) return;
  const std::string topic = "/kiva" + std::to_string(robot.id) + "/chassis/laser/scan";
  topics->scan = advertiseCounted<sensor_msgs::LaserScan>(
      node_, topic, kStreamQueue, [this, id = robot.id](int change) {
        audience_.count(Audience::RobotTopic::kScan, id, change);
      });
}

void RobotTopics::publish(const kiva::StatusChange& status) {
  const auto at = robots_.find(status.kiva_id);
  if (at != robots_.end() && at->second.status) at->second.status.publish(toMessage(status));
}

void RobotTopics::publish(const Scan& scan, double time) {
  const auto at = robots_.find(scan.kiva_id);
  if (at == robots_.end() || !at->second.scan) return;
  at->second.scan.publish(toMessage(scan, at->second.laser, time));
}

void RobotTopics::publishOdometry(const RobotPose& robot, double time) {
  const auto at = robots_.find(robot.kiva_id);
  if (at == robots_.end() || !at->second.odometry) return;
  at->second.odometry.publish(toMessage(robot, time));
}

}  // namespace kiva_ros
