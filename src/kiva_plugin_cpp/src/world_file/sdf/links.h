// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "world_file/sdf/shapes.h"

namespace kiva {

/// The frame and names of a nested model in the flattened model.
struct Scope {
  const Origin& origin;
  std::string prefix;  ///< `nested::`, empty for the outermost model.
  Pose pose;           ///< Pose of the nested model in the outermost one.
  bool is_static;
  bool self_collide;  ///< Default of its links.
};

/// Describes a link. Throws SdfError.
Link describeLink(const XmlElement& link, const Scope& scope, Faults* warnings);
Joint describeJoint(const XmlElement& joint, const Scope& scope);

}  // namespace kiva
