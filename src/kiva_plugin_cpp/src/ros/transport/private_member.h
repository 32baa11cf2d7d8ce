// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Access to private members of roscpp that has no public way. An explicit instantiation may name
/// private members:
///
///   struct Links : PrivateMember<Links, ros::V_ServiceClientLink ros::ServicePublication::*> {};
///   template struct Reveal<Links, &ros::ServicePublication::client_links_>;
/// makes memberOf(Links()) point to it. Such tags are in this namespace, each once.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-template-friend"  // a function for each tag is intended
template <typename Name, typename Pointer>
struct PrivateMember {
  using Type = Pointer;
  friend Pointer memberOf(Name);
};
#pragma GCC diagnostic pop

template <typename Name, typename Name::Type member>
struct Reveal {
  friend typename Name::Type memberOf(Name) { return member; }
};

}  // namespace kiva_ros
