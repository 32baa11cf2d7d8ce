// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/laser.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr double kLevel = 0.9998;  // cosine of a degree

}  // namespace

void Laser::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", model);
  const kiva::SensorDescription& from = sensor(p, "ray gpu_ray lidar gpu_lidar");
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  schedule_ = Schedule(from.update_rate);
  grid_ = RayGrid(from);
  grid_.up = {};  // the first layer of several: as a plane
  directions_ = grid_.directions();
  scan_.angle_min = static_cast<float>(grid_.across.least);
  scan_.angle_max = static_cast<float>(grid_.across.most);
  scan_.angle_increment = static_cast<float>(grid_.across.gap());
  scan_.range_min = static_cast<float>(grid_.min_range);
  scan_.range_max = static_cast<float>(grid_.max_range);
  scan_.header.frame_id = frame(p.text("frameName", "world"), true);
  scan_.intensities.assign(grid_.size(), 0);
  skip(p, {"alwaysOn", "updateRate", "gaussianNoise", "hokuyoMinIntensity"});
  publisher_ = advertise<sensor_msgs::LaserScan>(p.text("topicName", "/world"));
}

void Laser::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  sensor_msgs::LaserScan out = scan_;
  const std::string frame_id = out.header.frame_id;
  out.header = header(world.time(), frame_id);
  std::uint64_t ray = 0;
  for (double range : cast(world, link->pose * pose_in_link_)) {
    if (grid_.noise > 0 && std::isfinite(range)) {
      range += grid_.noise * noise(seed(), world.steps(), ray);
      range = std::clamp(range, 0.0, static_cast<double>(scan_.range_max));
    }
    ++ray;
    const bool is_near = range < scan_.range_min;
    out.ranges.push_back(is_near ? -std::numeric_limits<float>::infinity()
                                 : static_cast<float>(range));
  }
  publish(publisher_, std::move(out));
}

/// Casts the rays. A level sensor uses the faster cast, which ignores the floor: the rays of a
/// sensor that rocks with its robot by a fraction of a degree would otherwise hit the floor far
/// away.
std::vector<double> Laser::cast(const kiva::World& world, const kiva::Pose& pose) const {
  if (pose.Rot().ZAxis().Z() < kLevel) {
    return castFrom(world, pose, directions_, scan_.range_max, model());
  }
  const double yaw = pose.Rot().Yaw();
  std::vector<double> out;
  out.reserve(directions_.size());
  for (int ray = 0; ray < grid_.size(); ++ray) {
    out.push_back(
        world.rayCast(pose.Pos(), yaw + grid_.across.angle(ray), scan_.range_max, model()));
  }
  return out;
}

}  // namespace kiva_ros
