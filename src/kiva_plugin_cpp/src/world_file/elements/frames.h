// SPDX-License-Identifier: Apache-2.0
//
// Where the parts of a model or a world stand: poses are told relative to frames, by their names.
#pragma once

#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// The pose of a link, joint, frame, light, collision, visual, sensor or model in the model or the
/// world around it; for parts of a link, in the link. Throws SdfError where frames are told in a
/// circle or are not there.
Pose poseAround(const XmlElement& part);

/// The frame of that name, in the model or world `scope`. Throws SdfError.
Pose frameIn(const XmlElement& scope, const std::string& name);

/// The name, within `model`, of the link that a link, joint, frame or nested model of that name
/// belongs to; "world" for that. Throws SdfError.
std::string linkOf(const XmlElement& model, const std::string& name);

/// The link that stands for a whole model, `nested::link` if it is in a nested one; empty: none.
std::string canonicalLinkOf(const XmlElement& model);

}  // namespace kiva
