// SPDX-License-Identifier: Apache-2.0
#include "command_topics.h"

#include <boost/function.hpp>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr int kUnlimited = 0;  // every command is answered, however fast they come

}  // namespace

CommandTopics::CommandTopics(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation) {
  using Kind = kiva::Command::Kind;
  using warehouse_msgs::MoveAlong;
  const auto as_is = [](const auto& message) { return fromMessage(message); };
  subscribe<warehouse_msgs::MoveTo>(root, "/mov", as_is);
  subscribe<MoveAlong>(root, "/movx", [](auto& m) { return fromMessage(m, Kind::kMoveX); });
  subscribe<MoveAlong>(root, "/movy", [](auto& m) { return fromMessage(m, Kind::kMoveY); });
  subscribe<warehouse_msgs::Rotate>(root, "/rot", as_is);
  subscribe<warehouse_msgs::Lift>(root, "/lift", as_is);
}

template <typename Message, typename Convert>
void CommandTopics::subscribe(ros::NodeHandle& root, const std::string& topic, Convert convert) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> post =
      [this, convert](const boost::shared_ptr<const Message>& message) {
        simulation_.command(convert(*message));
      };
  subscribers_.push_back(root.subscribe<Message>(topic, kUnlimited, post, ros::VoidConstPtr(),
                                                 ros::TransportHints().tcpNoDelay()));
}

}  // namespace kiva_ros
