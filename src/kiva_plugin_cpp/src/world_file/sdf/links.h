// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "world_file/sdf/shapes.h"

namespace kiva {

/// Where a nested model's parts go in the one that is flattened.
struct Scope {
  const Origin& origin;
  std::string prefix;  ///< `nested::`, empty for the outermost model.
  Pose pose;           ///< Of the nested model, in the outermost one.
  bool is_static;
  bool self_collide;  ///< What its links do that do not say.
};

/// Throw SdfError.
Link describeLink(const XmlElement& link, const Scope& scope, Faults* warnings);
Joint describeJoint(const XmlElement& joint, const Scope& scope);

}  // namespace kiva
