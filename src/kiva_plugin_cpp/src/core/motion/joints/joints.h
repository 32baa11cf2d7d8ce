// SPDX-License-Identifier: Apache-2.0
//
// The joints of ordinary models: hinges and sliders in Bullet, with motors, damping and friction.
// Joints of robots belong to the robots' plugins.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/state/views/motion_view.h"

namespace kiva {

/// Sets the joints of a rebuilt model to zero, as in its description.
void initJoints(Model& model);
/// Sets the limits of rebuilt joints that were changed since the description.
void restoreLimits(Model& model);

/// Applies motors, damping and friction before Bullet's step.
void driveJoints(ModelTable& models, double dt);
/// Reads the joints' positions after Bullet's step.
void readJoints(ModelTable& models);

/// Returns the index of the joint of that name; -1 = none.
int findJoint(const Model& model, const std::string& joint);
JointState jointState(const FleetState& fleet, const Model& model, int joint);
/// Returns nothing for a model without free bodies.
std::optional<JointWrench> jointWrench(const Model& model, int joint);
void setJoint(Model& model, int joint, const JointSettings& settings);
/// Places all joints or none; throws std::invalid_argument.
void placeJoints(MotionView& world, Model& model, const std::map<std::string, double>& positions);
/// Applies an effort for the next step [Nm] or [N].
void pushJoint(Model& model, int joint, double effort);
/// Returns the indices of the links that joints connect to `link`, including itself. The joint
/// `without` is ignored, -1 = none.
std::vector<int> linksHeldTo(const ModelDescription& description, int link, int without = -1);

}  // namespace kiva
