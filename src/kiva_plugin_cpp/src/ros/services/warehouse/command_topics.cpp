// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/command_topics.h"

#include <boost/function.hpp>

#include "ros/messages/command_messages.h"

namespace kiva_ros {
namespace {

constexpr int kUnlimited = 0;  // every command is answered, at any rate

}  // namespace

CommandTopics::CommandTopics(ros::NodeHandle& root, SimulationThread& simulation) {
  forEachCommandTopic([&](auto type, const char* topic, auto toOrders) {
    using Message = typename decltype(type)::Message;
    const boost::function<void(const boost::shared_ptr<const Message>&)> post =
        [&simulation, toOrders](const boost::shared_ptr<const Message>& message) {
          simulation.command(toOrders(*message));
        };
    subscribers_.push_back(root.subscribe<Message>(topic, kUnlimited, post, ros::VoidConstPtr(),
                                                   ros::TransportHints().tcpNoDelay()));
  });
  const boost::function<void(const boost::shared_ptr<const warehouse_msgs::FleetOrders>&)> post =
      [&simulation](const boost::shared_ptr<const warehouse_msgs::FleetOrders>& message) {
        simulation.command(fromMessage(*message), message->timeline);
      };
  subscribers_.push_back(root.subscribe<warehouse_msgs::FleetOrders>(
      "warehouse/fleet_orders", kUnlimited, post, ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay()));
}

}  // namespace kiva_ros
