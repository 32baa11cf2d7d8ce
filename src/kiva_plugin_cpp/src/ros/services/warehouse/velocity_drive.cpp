// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/velocity_drive.h"

#include <cmath>
#include <stdexcept>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

constexpr double kReportAgain = 5;        // [s] between two events about one robot's messages
constexpr double kWarnAgainOfTwist = 10;  // [s], wall

std::string nameOf(int kiva_id) { return "kiva" + std::to_string(kiva_id); }

/// Returns the name of a velocity component that the robot can't follow; empty if it can follow
/// all.
std::string otherMotion(const geometry_msgs::Twist& twist) {
  const std::pair<const char*, double> others[] = {{"linear.y", twist.linear.y},
                                                   {"linear.z", twist.linear.z},
                                                   {"angular.x", twist.angular.x},
                                                   {"angular.y", twist.angular.y}};
  for (const auto& [name, value] : others) {
    if (value != 0) return name;
  }
  return "";
}

}  // namespace

VelocityDrive::VelocityDrive(ros::NodeHandle& root, SimulationThread& simulation,
                             Reporter& reporter, PluginInputs& inputs, const kiva::World& world,
                             const std::vector<int>& kiva_ids)
    : root_(root),
      simulation_(simulation),
      reporter_(reporter),
      inputs_(inputs),
      waiting_(kiva_ids.begin(), kiva_ids.end()),
      server_(serveCommand(root, "warehouse/set_cmd_vel", &VelocityDrive::set, this)) {
  subscribe(world);
}

/// Runs after the inputs have advanced, and before a recorder's keyframe: a keyframe has what was
/// handed over and asked for, and replaying the same message changes nothing.
bool VelocityDrive::beforeStep(kiva::World& world) {
  if (!waiting_.empty()) handOver(world);
  subscribe(world);
  for (auto& [kiva_id, rein] : reins_) {
    if (const geometry_msgs::Twist* twist = rein.input.take()) take(world, kiva_id, *twist, rein);
  }
  return true;
}

void VelocityDrive::handOver(kiva::World& world) {
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    const int robot = world.fleet().find(*at);
    const bool is_idle = robot >= 0 && world.fleet().status[robot] == kiva::Status::kIdle;
    if (!is_idle) {
      ++at;
      continue;
    }
    try {
      world.beginSteering(*at);
    } catch (const std::invalid_argument& error) {
      ROS_WARN("cmd_vel: %s", error.what());
    }
    at = waiting_.erase(at);
  }
}

/// Subscribes to the topics of the robots that are steered, and to no others.
void VelocityDrive::subscribe(const kiva::World& world) {
  const kiva::Fleet& f = world.fleet();
  const auto is_steered = [&](int kiva_id) {
    const int robot = f.find(kiva_id);
    return robot >= 0 && world.isSteered(robot);
  };
  for (auto at = reins_.begin(); at != reins_.end();) {
    at = is_steered(at->first) ? std::next(at) : reins_.erase(at);
  }
  for (const int kiva_id : world.steeredRobots()) {
    if (reins_.count(kiva_id)) continue;
    reins_[kiva_id].input =
        inputs_.subscribe<geometry_msgs::Twist>(root_, nameOf(kiva_id) + "/cmd_vel");
  }
}

void VelocityDrive::take(kiva::World& world, int kiva_id, const geometry_msgs::Twist& twist,
                         Rein& rein) {
  try {
    world.steer(kiva_id, twist.linear.x, twist.angular.z);
  } catch (const std::invalid_argument& error) {
    if (world.time() < rein.quiet_until && rein.quiet_until - world.time() <= kReportAgain) return;
    rein.quiet_until = world.time() + kReportAgain;
    reporter_.refused(world, kiva_id, std::string("cmd_vel of ") + error.what());
  }
  const std::string other = otherMotion(twist);
  if (other.empty()) return;
  ROS_WARN_THROTTLE(
      kWarnAgainOfTwist,
      "/%s/cmd_vel has a %s: the robot drives by linear.x and turns by angular.z alone",
      nameOf(kiva_id).c_str(), other.c_str());
}

bool VelocityDrive::set(const Request& request, Response& response) {
  return reply(response, [&] {
    simulation_.change([&](kiva::World& world) {
      if (request.enable) return world.beginSteering(request.kiva_id);
      world.endSteering(request.kiva_id);
    });
    return nameOf(request.kiva_id) +
           (request.enable ? " takes velocities from /" + nameOf(request.kiva_id) + "/cmd_vel"
                           : " takes commands along the grid");
  });
}

}  // namespace kiva_ros
