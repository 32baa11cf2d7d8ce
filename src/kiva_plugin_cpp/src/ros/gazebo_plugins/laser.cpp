// SPDX-License-Identifier: Apache-2.0
#include "laser.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr int kMostRays = 100000;
constexpr double kMostRange = 1e5;  // [m]

}  // namespace

void Laser::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", model);
  const kiva::SensorDescription& from = sensor(p, "ray gpu_ray lidar gpu_lidar");
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  schedule_ = Schedule(from.update_rate);
  const kiva::Parameters& s = from.parameters;
  const std::string ray = s.has("lidar/range/max") ? "lidar/" : "ray/";
  const std::string scan = ray + "scan/horizontal/";
  rays_ = s.whole(scan + "samples", 640, 1, kMostRays);
  least_ = s.number(scan + "min_angle", 0, -2 * M_PI, 2 * M_PI);
  most_ = s.number(scan + "max_angle", 0, least_, least_ + 4 * M_PI);
  noise_ = s.number(ray + "noise/stddev", 0, 0, kMostRange);
  scan_.angle_min = static_cast<float>(least_);
  scan_.angle_max = static_cast<float>(most_);
  scan_.angle_increment = static_cast<float>((most_ - least_) / std::max(rays_ - 1, 1));
  scan_.range_min = static_cast<float>(s.number(ray + "range/min", 0, 0, kMostRange));
  scan_.range_max = static_cast<float>(
      std::min(s.number(ray + "range/max", 0, 0, std::numeric_limits<double>::max()), kMostRange));
  scan_.header.frame_id = frame(p.text("frameName", "world"), true);
  scan_.intensities.assign(rays_, 0);
  skip(p, {"alwaysOn", "updateRate", "gaussianNoise", "hokuyoMinIntensity"});
  publisher_ = node().advertise<sensor_msgs::LaserScan>(p.text("topicName", "/world"), 10);
}

void Laser::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  const kiva::Pose pose = link->pose * pose_in_link_;
  const double yaw = pose.Rot().Yaw();
  const double gap = (most_ - least_) / std::max(rays_ - 1, 1);
  sensor_msgs::LaserScan out = scan_;
  const std::string frame_id = out.header.frame_id;
  out.header = header(world.time(), frame_id);
  for (int ray = 0; ray < rays_; ++ray) {
    double range = world.rayCast(pose.Pos(), yaw + least_ + gap * ray, scan_.range_max, model());
    if (noise_ > 0 && std::isfinite(range)) {
      range += noise_ * noise(seed(), world.steps(), ray);
      range = std::clamp(range, 0.0, static_cast<double>(scan_.range_max));
    }
    const bool is_near = range < scan_.range_min;
    out.ranges.push_back(is_near ? -std::numeric_limits<float>::infinity()
                                 : static_cast<float>(range));
  }
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
