// SPDX-License-Identifier: Apache-2.0
#include "lacking.h"

namespace kiva_ros {
namespace {

constexpr const char* kNoPictures =
    "nothing is rendered here, so it has no pictures to publish; the web page and 'rosrun "
    "warehouse_viewer render' draw the world, and libgazebo_ros_depth_camera.so and "
    "libgazebo_ros_openni_kinect.so measure depth";
constexpr const char* kNoControllers =
    "there are no ros_control controllers here, so nothing moves its joints; drive wheels by "
    "libgazebo_ros_diff_drive.so or libgazebo_ros_skid_steer_drive.so in its place, or the model "
    "by libgazebo_ros_planar_move.so; push other joints by /gazebo/apply_joint_effort and put them "
    "somewhere by /gazebo/set_model_configuration";
constexpr const char* kNoTrajectories =
    "joints follow no trajectories here; put them somewhere by /gazebo/set_model_configuration or "
    "push them by /gazebo/apply_joint_effort";
constexpr const char* kNoSteering =
    "there is no stand-in for steered wheels; drive the model by libgazebo_ros_planar_move.so or "
    "two of its wheels by libgazebo_ros_diff_drive.so";

}  // namespace

const std::map<std::string, std::string>& lackingPlugins() {
  static const std::map<std::string, std::string> all = {
      {"libgazebo_ros_camera.so", kNoPictures},
      {"libgazebo_ros_multicamera.so", kNoPictures},
      {"libgazebo_ros_triggered_camera.so", kNoPictures},
      {"libgazebo_ros_triggered_multicamera.so", kNoPictures},
      {"libgazebo_ros_prosilica.so", kNoPictures},
      {"libgazebo_ros_control.so", kNoControllers},
      {"libgazebo_ros_joint_trajectory.so", kNoTrajectories},
      {"libgazebo_ros_joint_pose_trajectory.so", kNoTrajectories},
      {"libgazebo_ros_tricycle_drive.so", kNoSteering},
      {"libgazebo_ros_ackermann_drive.so", kNoSteering},
  };
  return all;
}

}  // namespace kiva_ros
