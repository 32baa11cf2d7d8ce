// SPDX-License-Identifier: Apache-2.0
//
// The joints of ordinary models: hinges and sliders in Bullet, with motors, damping and friction. A
// robot's joints are its plugins' own.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/state/motion_view.h"

namespace kiva {

/// A model was put together anew: its joints are at zero, as its description has them.
void initJoints(Model& model);
/// Gives joints built anew the limits that were set since.
void restoreLimits(Model& model);

/// Before Bullet's step: what motors, damping and friction do.
void driveJoints(MotionView& world);
/// After it: where the joints are.
void readJoints(const ModelTable& models);

/// -1 = none.
int findJoint(const Model& model, const std::string& joint);
JointState jointState(const FleetState& fleet, const Model& model, int joint);
/// Nothing of a model without free bodies.
std::optional<JointWrench> jointWrench(const Model& model, int joint);
void setJoint(Model& model, int joint, const JointSettings& settings);
/// All or none; throws std::invalid_argument.
void placeJoints(MotionView& world, Model& model, const std::map<std::string, double>& positions);
/// For the next step [Nm] or [N].
void pushJoint(Model& model, int joint, double effort);
/// Indices of the links that joints hold to `link`, itself among them; `without` is a joint that
/// does not count, -1 = none.
std::vector<int> linksHeldTo(const ModelDescription& description, int link, int without = -1);

}  // namespace kiva
