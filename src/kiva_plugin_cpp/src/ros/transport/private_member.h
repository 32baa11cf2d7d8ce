// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {
namespace {  // of each file that includes this, as the tags are

/// Names a private member of a class of roscpp, where that offers no other way: an explicit
/// instantiation may.
///
///     struct Outbox {
///       using Type = std::queue<Message> Link::*;
///       friend Type memberOf(Outbox);
///     };
///     template struct PrivateMember<Outbox, &Link::outbox_>;  // then: link.*memberOf(Outbox())
template <typename Tag, typename Tag::Type member>
struct PrivateMember {
  friend typename Tag::Type memberOf(Tag) { return member; }
};

}  // namespace
}  // namespace kiva_ros
