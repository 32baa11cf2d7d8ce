// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/command_topics.h"

#include <warehouse_msgs/Command.h>

#include <boost/function.hpp>
#include <sstream>
#include <type_traits>

#include "ros/messages/command_messages.h"

namespace kiva_ros {
namespace {

constexpr int kUnlimited = 0;  // every command is answered, at any rate
constexpr int kHeardQueue = 1000;

template <typename Message>
constexpr bool kIsPath = std::is_same<Message, warehouse_msgs::FollowPath>::value ||
                         std::is_same<Message, warehouse_msgs::LimitedPath>::value ||
                         std::is_same<Message, warehouse_msgs::FleetFollow>::value;

template <typename Message>
warehouse_msgs::Command heard(const std::string& topic,
                              const ros::MessageEvent<const Message>& event) {
  std::ostringstream fields;
  fields << *event.getConstMessage();
  warehouse_msgs::Command command;
  command.topic = topic;
  command.sender = event.getPublisherName();
  command.fields = fields.str();
  return command;
}

}  // namespace

CommandTopics::CommandTopics(ros::NodeHandle& root, SimulationThread& simulation)
    : heard_(root.advertise<warehouse_msgs::Command>("warehouse/commands", kHeardQueue)) {
  forEachCommandTopic([&](auto type, const char* topic, auto toOrders) {
    using Message = typename decltype(type)::Message;
    using Event = const ros::MessageEvent<const Message>&;
    const std::string name = root.resolveName(topic);
    const boost::function<void(Event)> post = [this, &simulation, toOrders, name](Event event) {
      if (!kIsPath<Message> && heard_.getNumSubscribers()) heard_.publish(heard(name, event));
      simulation.command(toOrders(*event.getConstMessage()));
    };
    subscribers_.push_back(root.subscribe<Message, Event>(
        topic, kUnlimited, post, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
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
