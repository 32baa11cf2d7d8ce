// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <boost/function.hpp>
#include <exception>
#include <stdexcept>
#include <string>

#include "ros/services/base/command_service.h"

namespace kiva_ros {

/// Refuses a request; the text is the status message that Gazebo's clients know.
struct ServiceRefusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Fills a response with the status text that `body` returns, or with the text of its exception: a
/// failure is a reply with its cause, not a failed call.
template <typename Response, typename Body>
bool answer(const std::string& service, Response& response, Body body) {
  try {
    response.status_message = body();
    response.success = true;
  } catch (const ServiceRefusal& refusal) {
    response.success = false;
    response.status_message = refusal.what();
  } catch (const std::exception& error) {
    response.success = false;
    response.status_message = service + ": Failure - " + error.what();
  }
  return true;
}

/// Does the same for our own responses, whose text is the field `message`.
template <typename Response, typename Body>
bool reply(Response& response, Body body) {
  try {
    response.message = body();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

/// Returns what answers requests with such responses: `body(request, response)` returns the status
/// text. `label`: the service's name in texts.
template <typename Body>
auto answering(const std::string& label, Body body) {
  return [label, body](auto& request, auto& response) {
    return answer(label, response, [&] { return std::string(body(request, response)); });
  };
}

/// Advertises a service that answering() answers.
template <typename Service, typename Body>
ros::ServiceServer serve(ros::NodeHandle& node, const std::string& name, const std::string& label,
                         Body body) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> call = answering(label, body);
  return node.advertiseService<Request, Response>(name, call);
}

/// Advertises a service as serve() does, and publishes its calls, since it changes something.
template <typename Service, typename Body>
ros::ServiceServer serveChange(ros::NodeHandle& node, const std::string& name,
                               const std::string& label, Body body) {
  return serveCommand<typename Service::Request, typename Service::Response>(
      node, name, answering(label, body));
}

}  // namespace kiva_ros
