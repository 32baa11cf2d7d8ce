// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/velodyne_laser.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr double kNoReturn = std::numeric_limits<double>::quiet_NaN();

/// Writes points one after the other.
class PointWriter {
 public:
  PointWriter(sensor_msgs::PointCloud2* cloud, std::size_t most) : modifier_(*cloud) {
    using Field = sensor_msgs::PointField;
    modifier_.setPointCloud2Fields(6, "x", 1, Field::FLOAT32, "y", 1, Field::FLOAT32, "z", 1,
                                   Field::FLOAT32, "intensity", 1, Field::FLOAT32, "ring", 1,
                                   Field::UINT16, "time", 1, Field::FLOAT32);
    modifier_.resize(most);
    place_ = std::make_unique<Place>(*cloud);
  }

  void add(const kiva::Vector3& point, int ring) {
    for (int i = 0; i < 3; ++i) place_->x[i] = static_cast<float>(point[i]);
    *place_->ring = static_cast<std::uint16_t>(ring);
    ++place_->x;
    ++place_->ring;
    ++count_;
  }
  /// Releases the room of points that were not written.
  void finish() { modifier_.resize(count_); }

 private:
  struct Place {
    explicit Place(sensor_msgs::PointCloud2& cloud) : x(cloud, "x"), ring(cloud, "ring") {}
    sensor_msgs::PointCloud2Iterator<float> x;
    sensor_msgs::PointCloud2Iterator<std::uint16_t> ring;
  };
  sensor_msgs::PointCloud2Modifier modifier_;
  std::unique_ptr<Place> place_;
  std::size_t count_ = 0;
};

}  // namespace

void VelodyneLaser::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const kiva::SensorDescription& from = sensor(p, "ray gpu_ray lidar gpu_lidar");
  grid_ = RayGrid(from);
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  directions_ = grid_.directions();
  min_range_ = std::max(grid_.min_range, p.number("min_range", 0, 0, 1e6));
  max_range_ = std::min(grid_.max_range, p.number("max_range", 1e6, 0, 1e9));
  noise_ = std::hypot(p.number("gaussianNoise", 0, 0, 1e6), grid_.noise);
  is_organized_ = p.flag("organize_cloud", false);
  schedule_ = Schedule(from.update_rate);
  frame_ = frame(p.text("frameName", "/world"));
  skip(p, {"alwaysOn", "updateRate", "min_intensity"});
  publisher_ = advertise<sensor_msgs::PointCloud2>(p.text("topicName", "/points"));
}

void VelodyneLaser::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  const kiva::Pose pose = link->pose * pose_in_link_;
  const std::vector<double> ranges = castFrom(world, pose, directions_, max_range_, model());
  sensor_msgs::PointCloud2 out;
  out.header = header(world.time(), frame_);
  out.is_dense = !is_organized_;
  PointWriter writer(&out, ranges.size());
  for (std::size_t ray = 0; ray < ranges.size(); ++ray) {
    const int ring = static_cast<int>(ray) / grid_.across.samples;
    const bool is_hit = std::isfinite(ranges[ray]) && ranges[ray] >= min_range_;
    if (!is_hit && !is_organized_) continue;
    double range = is_hit ? ranges[ray] : kNoReturn;
    if (noise_ > 0) range += noise_ * noise(seed(), world.steps(), ray);
    writer.add(directions_[ray] * range, ring);
  }
  writer.finish();
  if (is_organized_) {
    out.height = grid_.up.samples;
    out.width = grid_.across.samples;
    out.row_step = out.width * out.point_step;
  }
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
