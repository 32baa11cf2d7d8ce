// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <boost/function.hpp>
#include <exception>
#include <stdexcept>
#include <string>

namespace kiva_ros {

/// Refuses a request with the status text that clients know.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Fills a response with what `body` returns, the status text, or with what it throws: a failure
/// is a reply that names its cause, never a call that fails.
template <typename Response, typename Body>
bool answer(const std::string& service, Response& response, Body body) {
  try {
    response.status_message = body();
    response.success = true;
  } catch (const Refusal& refusal) {
    response.success = false;
    response.status_message = refusal.what();
  } catch (const std::exception& error) {
    response.success = false;
    response.status_message = service + ": Failure - " + error.what();
  }
  return true;
}

/// The same for responses of our own, whose text is called message.
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

/// Advertises a service with such responses: `body(request, response)` returns the status text.
/// `label`: what the service is called in texts.
template <typename Service, typename Body>
ros::ServiceServer serve(ros::NodeHandle& node, const std::string& name, const std::string& label,
                         Body body) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> call = [label, body](Request& request,
                                                                        Response& response) {
    return answer(label, response, [&] { return std::string(body(request, response)); });
  };
  return node.advertiseService<Request, Response>(name, call);
}

}  // namespace kiva_ros
