// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/depth_camera.h"

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "ros/gazebo_plugins/rays/ray_grid.h"
#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr int kMostPixels = 1000000;
constexpr double kMostRate = 30;     // [Hz] where a sensor names none
constexpr double kMostDepth = 1000;  // [m]
constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kGrey = 128;  // colour of points, which is unknown

}  // namespace

double DepthCamera::farthest(const kiva::Parameters& p, double far_clip) const {
  skip(p, {"pointCloudCutoffMax"});
  return far_clip;
}

double OpenniKinect::farthest(const kiva::Parameters& p, double far_clip) const {
  return std::min(far_clip, p.number("pointCloudCutoffMax", 5, 0, kMostDepth));
}

void DepthCamera::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", model);
  const kiva::SensorDescription& from = sensor(p, "depth depth_camera rgbd_camera camera");
  link_ = from.link;
  pose_in_link_ = from.pose_in_link;
  frame_ = frame(p.text("frameName", "/world"), true);
  readImage(from, p);
  setRays();
  const double rate = slower(from.update_rate, p.number("updateRate", 0, 0, 1e6));
  schedule_ = Schedule(rate > 0 ? rate : kMostRate);
  skip(p, {"alwaysOn", "hackBaseline", "distortionK1", "distortionK2", "distortionK3",
           "distortionT1", "distortionT2", "CxPrime", "Cx", "Cy", "focalLength", "borderCrop",
           "imageTopicName", "baseline", "rangeMin"});
  openTopics(p);
  world.warn(p.where() + ": depth only: nothing is rendered here, so there is no colour image on " +
             node().resolveName(p.text("imageTopicName", "image_raw")) +
             "; the web page and 'rosrun warehouse_viewer render' draw the world");
}

void DepthCamera::readImage(const kiva::SensorDescription& from, const kiva::Parameters& p) {
  const kiva::Parameters& s = from.parameters;
  const int step = p.whole("everyNthPixel", 1, 1, 1000);
  const int columns = s.whole("camera/image/width", 320, 1, 100000);
  const int rows = s.whole("camera/image/height", 240, 1, 100000);
  const double field = s.number("camera/horizontal_fov", 1.047, 0.01, 3.1);
  width_ = (columns + step - 1) / step;
  height_ = (rows + step - 1) / step;
  if (height_ > kMostPixels / width_) {
    throw kiva::DescriptionError("an image of " + std::to_string(width_) + " x " +
                                 std::to_string(height_) + " has more than " +
                                 std::to_string(kMostPixels) +
                                 " pixels, a ray each; <everyNthPixel> makes it smaller");
  }
  focal_length_ = columns / (2 * std::tan(field / 2)) / step;
  const double near_clip = s.number("camera/clip/near", 0.1, 0, kMostDepth);
  const double far_clip = s.number("camera/clip/far", 100, near_clip, 1e6);
  nearest_ = std::max(near_clip, p.number("pointCloudCutoff", 0.4, 0, kMostDepth));
  farthest_ = farthest(p, std::min(far_clip, kMostDepth));
}

/// Sets rays through the centres of pixels, and `info_` for them. <Cx>, <Cy> and <focalLength>,
/// which in Gazebo change only the camera's description, are ignored, so that image and cloud
/// agree.
void DepthCamera::setRays() {
  const double x = 0.5 * (width_ - 1), y = 0.5 * (height_ - 1);
  directions_.clear();
  directions_.reserve(static_cast<std::size_t>(width_) * height_);
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      directions_.push_back(
          kiva::Vector3(1, (x - column) / focal_length_, (y - row) / focal_length_).Normalized());
    }
  }
  info_.width = width_;
  info_.height = height_;
  info_.distortion_model = "plumb_bob";
  info_.D.assign(5, 0);
  info_.K = {focal_length_, 0, x, 0, focal_length_, y, 0, 0, 1};
  info_.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info_.P = {focal_length_, 0, x, 0, 0, focal_length_, y, 0, 0, 0, 1, 0};
}

void DepthCamera::openTopics(const kiva::Parameters& p) {
  const std::string camera = p.text("cameraName", "");
  const auto topic = [&](const char* key, const char* fallback) {
    const std::string name = p.text(key, fallback);
    return camera.empty() || name.empty() || name[0] == '/' ? name : camera + "/" + name;
  };
  cloud_ = advertise<sensor_msgs::PointCloud2>(topic("pointCloudTopicName", "points"), 2);
  image_ = advertise<sensor_msgs::Image>(topic("depthImageTopicName", "depth/image_raw"), 2);
  image_info_ = advertise<sensor_msgs::CameraInfo>(
      topic("depthImageCameraInfoTopicName", "depth/camera_info"));
  colour_info_ = advertise<sensor_msgs::CameraInfo>(topic("cameraInfoTopicName", "ir/camera_info"));
}

void DepthCamera::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time())) return;
  const auto hasSubscribers = [](const ros::Publisher& p) { return p.getNumSubscribers() > 0; };
  const bool is_looked_at = hasSubscribers(cloud_) || hasSubscribers(image_);
  if (!is_looked_at && !hasSubscribers(image_info_) && !hasSubscribers(colour_info_)) return;
  const auto link = world.state(model(), link_);
  if (!link) return;
  const std_msgs::Header stamp = header(world.time(), frame_);
  info_.header = stamp;
  for (const ros::Publisher& info : {image_info_, colour_info_}) {
    if (hasSubscribers(info)) publish(info, info_);
  }
  if (!is_looked_at) return;
  const std::vector<float> pixels = depths(world, link->pose * pose_in_link_);
  if (hasSubscribers(image_)) publishImage(stamp, pixels);
  if (hasSubscribers(cloud_)) publishCloud(stamp, pixels);
}

/// Returns depths along the optical axis [m]; NaN for depths outside of nearest_ to farthest_.
std::vector<float> DepthCamera::depths(const kiva::World& world, const kiva::Pose& pose) const {
  const double corner = 1 / directions_.front().X();  // the longest ray to a plane ahead
  const std::vector<double> ranges =
      castFrom(world, pose, directions_, farthest_ * corner, model());
  std::vector<float> out(ranges.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double depth = ranges[i] * directions_[i].X();
    out[i] = depth > nearest_ && depth < farthest_ ? static_cast<float>(depth) : kNoDepth;
  }
  return out;
}

void DepthCamera::publishImage(const std_msgs::Header& header, const std::vector<float>& depths) {
  sensor_msgs::Image out;
  out.header = header;
  out.encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  out.width = width_;
  out.height = height_;
  out.step = width_ * sizeof(float);
  out.data.resize(depths.size() * sizeof(float));
  std::memcpy(out.data.data(), depths.data(), out.data.size());
  publish(image_, std::move(out));
}

void DepthCamera::publishCloud(const std_msgs::Header& header, const std::vector<float>& depths) {
  sensor_msgs::PointCloud2 out;
  out.header = header;
  sensor_msgs::PointCloud2Modifier modifier(out);
  modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
  modifier.resize(depths.size());
  out.width = width_;
  out.height = height_;
  out.row_step = out.point_step * out.width;
  out.is_dense = false;
  sensor_msgs::PointCloud2Iterator<float> point(out, "x");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> colour(out, "rgb");
  for (std::size_t i = 0; i < depths.size(); ++i, ++point, ++colour) {
    const kiva::Vector3& way = directions_[i];
    point[0] = static_cast<float>(-way.Y() / way.X()) * depths[i];
    point[1] = static_cast<float>(-way.Z() / way.X()) * depths[i];
    point[2] = depths[i];
    for (int k = 0; k < 3; ++k) colour[k] = kGrey;
  }
  publish(cloud_, std::move(out));
}

}  // namespace kiva_ros
