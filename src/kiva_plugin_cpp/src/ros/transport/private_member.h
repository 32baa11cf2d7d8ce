// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// What roscpp offers no way to ask for. An explicit instantiation may name private members:
///
///   struct Links {
///     using Type = ros::V_ServiceClientLink ros::ServicePublication::*;
///     friend Type memberOf(Links);
///   };
///   template struct PrivateMember<Links, &ros::ServicePublication::client_links_>;
///
/// makes memberOf(Links()) point to it. Such names stand in this namespace, each once.
template <typename Tag, typename Tag::Type member>
struct PrivateMember {
  friend typename Tag::Type memberOf(Tag) { return member; }
};

}  // namespace kiva_ros
