// SPDX-License-Identifier: Apache-2.0
#include "service_caller.h"

#include <ros/connection.h>
#include <ros/service_client_link.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>

namespace kiva_ros {
namespace {

// roscpp tells a service's callback nothing of the connection, and offers no way to ask for it. An
// explicit instantiation may name private members.
template <typename Tag, typename Tag::Type member>
struct Access {
  friend typename Tag::Type memberOf(Tag) { return member; }
};
struct Links {
  using Type = ros::V_ServiceClientLink ros::ServicePublication::*;
  friend Type memberOf(Links);
};
struct LinksMutex {
  using Type = boost::mutex ros::ServicePublication::*;
  friend Type memberOf(LinksMutex);
};
template struct Access<Links, &ros::ServicePublication::client_links_>;
template struct Access<LinksMutex, &ros::ServicePublication::client_links_mutex_>;

}  // namespace

ServiceCaller::ServiceCaller(const std::string& service, const ros::M_string& header) {
  const auto publication = ros::ServiceManager::instance()->lookupServicePublication(service);
  if (!publication) return;
  const boost::mutex::scoped_lock lock((*publication).*memberOf(LinksMutex()));
  for (const ros::ServiceClientLinkPtr& link : (*publication).*memberOf(Links())) {
    const ros::ConnectionPtr& connection = link->getConnection();
    if (connection->getHeader().getValues().get() == &header) connection_ = connection;
  }
}

bool ServiceCaller::isGone() const { return !connection_ || connection_->isDropped(); }

}  // namespace kiva_ros
