// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <boost/function.hpp>
#include <string>

#include "ros/services/base/request_text.h"

namespace kiva_ros {

/// Publishes the calls of a service, with caller and fields, on /warehouse/service_calls in the
/// world's namespace.
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

/// Advertises a service that changes something. Publishes each call on the CallTopic, then has
/// act(request, response) answer it.
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

/// Advertises a method of `part` as such a service.
template <typename Part, typename Request, typename Response>
ros::ServiceServer serveCommand(ros::NodeHandle& node, const std::string& name,
                                bool (Part::*act)(const Request&, Response&), Part* part) {
  const auto call = [act, part](const Request& request, Response& response) {
    return (part->*act)(request, response);
  };
  return serveCommand<Request, Response>(node, name, call);
}

}  // namespace kiva_ros
