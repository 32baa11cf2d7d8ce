// SPDX-License-Identifier: Apache-2.0
//
// The frames by whose names SDF gives poses of the parts of a model or a world.
#pragma once

#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// Returns the pose of a link, joint, frame, light, collision, visual, sensor or model in the model
/// or world around it; the pose of a link's part in the link. Throws SdfError where a frame is
/// missing or frames refer to each other in a circle.
Pose poseAround(const XmlElement& part);

/// Returns the frame of that name in the model or world `scope`. Throws SdfError.
Pose frameIn(const XmlElement& scope, const std::string& name);

/// Returns the name, within `model`, of the link that a link, joint, frame or nested model of that
/// name belongs to, or "world". Throws SdfError.
std::string linkOf(const XmlElement& model, const std::string& name);

/// Returns the link that stands for a whole model, `nested::link` if it is in a nested one, or "".
std::string canonicalLinkOf(const XmlElement& model);

}  // namespace kiva
