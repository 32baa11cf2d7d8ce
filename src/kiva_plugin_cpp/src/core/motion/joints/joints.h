// SPDX-License-Identifier: Apache-2.0
//
// The joints of ordinary models: hinges and sliders in Bullet, with motors, damping and friction. A
// robot's joints are its plugins' own.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/state/views/motion_view.h"

namespace kiva {

/// Puts the joints of a rebuilt model at zero, as its description has them.
void initJoints(Model& model);
/// Gives rebuilt joints the limits that were set since.
void restoreLimits(Model& model);

/// Applies motors, damping and friction before Bullet's step.
void driveJoints(MotionView& world);
/// Reads the joints' positions after Bullet's step.
void readJoints(const ModelTable& models);

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
/// Returns the indices of the links that joints hold to `link`, itself among them; `without` is a
/// joint that does not count, -1 = none.
std::vector<int> linksHeldTo(const ModelDescription& description, int link, int without = -1);

}  // namespace kiva
