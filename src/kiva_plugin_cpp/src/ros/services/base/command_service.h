// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <boost/function.hpp>
#include <string>

#include "ros/services/base/request_text.h"

namespace kiva_ros {

/// Tells on /warehouse/service_calls, in the world's namespace, who called a service and how.
class CallTopic {
 public:
  /// `service`: its full name.
  explicit CallTopic(const std::string& service);

  template <typename Request>
  void tell(const std::string& caller, const Request& request) const {
    if (topic_.getNumSubscribers()) publish(caller, fieldsOf(request));
  }

 private:
  void publish(const std::string& caller, const std::string& fields) const;

  std::string service_;
  ros::Publisher topic_;
};

/// Advertises a service that changes something: each call is told on the topic before
/// act(request, response) answers it.
template <typename Request, typename Response, typename Act>
ros::ServiceServer serveCommand(ros::NodeHandle& node, const std::string& name, Act act) {
  using Event = ros::ServiceEvent<Request, Response>;
  const boost::function<bool(Event&)> take = [calls = CallTopic(node.resolveName(name)),
                                              act](Event& event) {
    calls.tell(event.getCallerName(), event.getRequest());
    return act(event.getRequest(), event.getResponse());
  };
  return node.advertiseService<Event>(name, take);
}

/// Does so for a method of `part`.
template <typename Part, typename Request, typename Response>
ros::ServiceServer serveCommand(ros::NodeHandle& node, const std::string& name,
                                bool (Part::*act)(const Request&, Response&), Part* part) {
  const auto call = [act, part](const Request& request, Response& response) {
    return (part->*act)(request, response);
  };
  return serveCommand<Request, Response>(node, name, call);
}

}  // namespace kiva_ros
