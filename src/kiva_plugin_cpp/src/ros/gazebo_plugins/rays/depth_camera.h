// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_openni_kinect.so and libgazebo_ros_depth_camera.so in a <sensor
/// type="depth">: publishes a cloud of points and a depth image in the optical frame (x right, y
/// down, z ahead), by a ray a pixel against collisions, while there are subscribers. Colours are
/// not rendered.
class DepthCamera : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 protected:
  virtual double farthest(const kiva::Parameters& parameters, double far_clip) const;

 private:
  void readImage(const kiva::SensorDescription& from, const kiva::Parameters& parameters);
  void openTopics(const kiva::Parameters& parameters);
  void setRays();
  std::vector<float> depths(const kiva::World& world, const kiva::Pose& pose) const;
  void publishImage(const std_msgs::Header& header, const std::vector<float>& depths);
  void publishCloud(const std_msgs::Header& header, const std::vector<float>& depths);

  std::string link_, frame_;
  kiva::Pose pose_in_link_;
  int width_ = 0, height_ = 0;             ///< Of the images that are published.
  double focal_length_ = 0;                ///< [pixels]
  double nearest_ = 0, farthest_ = 0;      ///< Depths between which pixels have a value [m].
  std::vector<kiva::Vector3> directions_;  ///< Of all pixels, row by row, in the sensor's frame.
  sensor_msgs::CameraInfo info_;
  Schedule schedule_;
  ros::Publisher cloud_, image_, image_info_, colour_info_;
};

/// Stands in for libgazebo_ros_openni_kinect.so, whose range is shorter.
class OpenniKinect : public DepthCamera {
 public:
  using DepthCamera::DepthCamera;

 protected:
  double farthest(const kiva::Parameters& parameters, double far_clip) const override;
};

}  // namespace kiva_ros
