// SPDX-License-Identifier: Apache-2.0
#include "unadvertise.h"

#include <ros/publication.h>
#include <ros/ros.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include <string>

namespace kiva_ros {
namespace {

XmlRpc::XmlRpcValue unregisterPublisher(const std::string& topic) {
  XmlRpc::XmlRpcValue call;
  call["methodName"] = std::string("unregisterPublisher");
  call["params"][0] = ros::this_node::getName();
  call["params"][1] = topic;
  call["params"][2] = ros::XMLRPCManager::instance()->getServerURI();
  return call;
}

}  // namespace

void unadvertiseTopics() {
  const auto& topics = ros::TopicManager::instance();
  ros::V_string names;
  topics->getAdvertisedTopics(names);
  if (names.empty()) return;
  XmlRpc::XmlRpcValue calls, response, payload;
  calls[0].setSize(static_cast<int>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    calls[0][static_cast<int>(i)] = unregisterPublisher(names[i]);
  }
  // The return value is meaningless: the answer is not one of the master's usual triples.
  ros::master::execute("system.multicall", calls, response, payload, false);
  for (const std::string& name : names) {
    // roscpp ignores a topic that is dropped already.
    if (const ros::PublicationPtr topic = topics->lookupPublication(name)) topic->drop();
  }
}

}  // namespace kiva_ros
