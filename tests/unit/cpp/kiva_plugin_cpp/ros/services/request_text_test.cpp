// SPDX-License-Identifier: Apache-2.0
//
// A request as YAML, by the printer that its message brings.
#include "ros/services/base/request_text.h"

#include <gazebo_msgs/SetModelConfiguration.h>
#include <gazebo_msgs/SpawnModel.h>
#include <gtest/gtest.h>

namespace kiva_ros {
namespace {

TEST(RequestText, aTextIsQuoted) {
  gazebo_msgs::SpawnModel::Request request;
  request.model_name = "a: \"b\"\n- \\c";
  const std::string fields = fieldsOf(request);
  EXPECT_NE(fields.find("model_name: \"a: \\\"b\\\"\\x0A- \\\\c\"\n"), std::string::npos) << fields;
  EXPECT_NE(fields.find("robot_namespace: \"\"\n"), std::string::npos) << fields;
}

TEST(RequestText, aLongTextIsCutBetweenCharacters) {
  gazebo_msgs::SpawnModel::Request request;
  request.model_xml = std::string(199, 'x') + "ö" + std::string(5000, 'y');
  const std::string fields = fieldsOf(request);
  EXPECT_NE(fields.find("x… (5201 bytes)\"\n"), std::string::npos) << fields;
}

TEST(RequestText, arraysAreLists) {
  gazebo_msgs::SetModelConfiguration::Request request;
  request.model_name = "names[0]: 1";  // no element of an array
  request.joint_names = {"left", "right"};
  request.joint_positions = {0.1, -2};
  EXPECT_EQ(fieldsOf(request),
            "model_name: \"names[0]: 1\"\nurdf_param_name: \"\"\njoint_names:\n  - \"left\"\n"
            "  - \"right\"\njoint_positions:\n  - 0.1\n  - -2\n");
}

}  // namespace
}  // namespace kiva_ros
