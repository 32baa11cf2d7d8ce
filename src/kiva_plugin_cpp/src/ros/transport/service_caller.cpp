// SPDX-License-Identifier: Apache-2.0
#include "service_caller.h"

#include <ros/connection.h>
#include <ros/service_client_link.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>

#include "private_member.h"

namespace kiva_ros {

// Access to the connection of a call, which roscpp does not pass to a service's callback.
struct ServiceLinks
    : PrivateMember<ServiceLinks, ros::V_ServiceClientLink ros::ServicePublication::*> {};
struct ServiceLinksMutex
    : PrivateMember<ServiceLinksMutex, boost::mutex ros::ServicePublication::*> {};
template struct Reveal<ServiceLinks, &ros::ServicePublication::client_links_>;
template struct Reveal<ServiceLinksMutex, &ros::ServicePublication::client_links_mutex_>;

ServiceCaller::ServiceCaller(const std::string& service, const ros::M_string& header) {
  const auto publication = ros::ServiceManager::instance()->lookupServicePublication(service);
  if (!publication) return;
  const boost::mutex::scoped_lock lock((*publication).*memberOf(ServiceLinksMutex()));
  for (const ros::ServiceClientLinkPtr& link : (*publication).*memberOf(ServiceLinks())) {
    const ros::ConnectionPtr& connection = link->getConnection();
    if (connection->getHeader().getValues().get() == &header) connection_ = connection;
  }
}

bool ServiceCaller::isGone() const { return !connection_ || connection_->isDropped(); }

}  // namespace kiva_ros
