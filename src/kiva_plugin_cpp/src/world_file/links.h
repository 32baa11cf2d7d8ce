// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Types.hh>
#include <string>

#include "kiva_plugin_cpp/description.h"
#include "world_file/shapes.h"

namespace kiva {

/// Where a nested model's parts go in the one that is flattened.
struct Scope {
  const Origin& origin;
  std::string prefix;  ///< `nested::`, empty for the outermost model.
  Pose pose;           ///< Of the nested model, in the outermost one.
  bool is_static;
};

/// Throw SdfError.
Link describeLink(const sdf::Link& link, const Scope& scope, sdf::Errors* warnings);
Joint describeJoint(const sdf::Joint& joint, const Scope& scope);

}  // namespace kiva
