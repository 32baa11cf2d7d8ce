// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/block_laser.h"

#include <cmath>

#include "ros/messages/convert.h"

namespace kiva_ros {

void BlockLaser::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const kiva::SensorDescription& from = sensor(p, "ray gpu_ray lidar gpu_lidar");
  const RayGrid grid(from);
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  directions_ = grid.directions();
  max_range_ = grid.max_range;
  noise_ = std::hypot(p.number("gaussianNoise", 0, 0, 1e6), grid.noise);
  schedule_ = Schedule(from.update_rate);
  frame_ = frame(p.text("frameName", "/world"));
  skip(p, {"alwaysOn", "updateRate", "hokuyoMinIntensity"});
  publisher_ = advertise<sensor_msgs::PointCloud>(p.text("topicName", "/world"));
}

void BlockLaser::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  const kiva::Pose pose = link->pose * pose_in_link_;
  const std::vector<double> ranges = castFrom(world, pose, directions_, max_range_, model());
  sensor_msgs::PointCloud out;
  out.header = header(world.time(), frame_);
  out.points.resize(ranges.size());
  out.channels.resize(1);
  out.channels[0].name = "intensity";
  out.channels[0].values.assign(ranges.size(), 0);
  for (std::size_t ray = 0; ray < ranges.size(); ++ray) {
    const bool is_hit = std::isfinite(ranges[ray]);
    const kiva::Vector3 point = noisy(world, directions_[ray] * (is_hit ? ranges[ray] : max_range_),
                                      is_hit ? noise_ : 0, 3 * ray);
    out.points[ray].x = static_cast<float>(point.X());
    out.points[ray].y = static_cast<float>(point.Y());
    out.points[ray].z = static_cast<float>(point.Z());
  }
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
