// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/range.h"

#include <algorithm>
#include <cmath>

#include "ros/messages/convert.h"

namespace kiva_ros {

void Range::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const kiva::SensorDescription& from = sensor(p, "ray gpu_ray lidar gpu_lidar");
  const RayGrid grid(from);
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  directions_ = grid.directions();
  noise_ = std::hypot(p.number("gaussianNoise", 0, 0, 1e6), grid.noise);
  schedule_ = Schedule(slower(p.number("updateRate", 0, 0, 1e6), from.update_rate));
  range_.header.frame_id = frame(p.text("frameName", "/world"));
  range_.radiation_type = p.text("radiation", "ultrasound") == "ultrasound"
                              ? sensor_msgs::Range::ULTRASOUND
                              : sensor_msgs::Range::INFRARED;
  range_.field_of_view = static_cast<float>(p.number("fov", 0.05, 0, 2 * M_PI));
  range_.min_range = static_cast<float>(grid.min_range);
  range_.max_range = static_cast<float>(grid.max_range);
  skip(p, {"alwaysOn", "visualize"});
  publisher_ = advertise<sensor_msgs::Range>(p.text("topicName", "/range"));
}

void Range::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  const double most = range_.max_range;
  const std::vector<double> met =
      castFrom(world, link->pose * pose_in_link_, directions_, most, model());
  double nearest = std::min(most, *std::min_element(met.begin(), met.end()));
  if (nearest < most && noise_ > 0) nearest += noise_ * noise(seed(), world.steps(), 0);
  sensor_msgs::Range out = range_;
  const std::string frame_id = range_.header.frame_id;
  out.header = header(world.time(), frame_id);
  out.range =
      static_cast<float>(std::clamp(nearest, std::min<double>(range_.min_range, most), most));
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
