// SPDX-License-Identifier: Apache-2.0
//
// What libsdformat gives, as the geometry of the descriptions.
#pragma once

#include <ignition/math/Pose3.hh>
#include <sdf/Element.hh>
#include <string>

#include "kiva_plugin_cpp/geometry.h"

namespace kiva {

inline Vector3 fromSdformat(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

inline Pose fromSdformat(const ignition::math::Pose3d& pose) {
  const ignition::math::Quaterniond& q = pose.Rot();
  return {fromSdformat(pose.Pos()), {q.W(), q.X(), q.Y(), q.Z()}};
}

/// Three numbers in `name` of `element`, or `otherwise` if it is not there.
inline Vector3 vectorIn(const sdf::ElementPtr& element, const std::string& name,
                        const Vector3& otherwise) {
  const ignition::math::Vector3d fallback(otherwise.X(), otherwise.Y(), otherwise.Z());
  return fromSdformat(element->Get(name, fallback).first);
}

/// Three numbers in `element` itself.
inline Vector3 vectorIn(const sdf::ElementPtr& element) {
  return fromSdformat(element->Get<ignition::math::Vector3d>());
}

}  // namespace kiva
