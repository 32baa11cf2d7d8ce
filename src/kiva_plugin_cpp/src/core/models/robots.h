// SPDX-License-Identifier: Apache-2.0
//
// Kiva robots: integrated in arrays while nothing is near, see contact/activation.h.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

class Robots : public ModelOwner {
 public:
  void add(ModelView& world, Model& model) const override;
  void remove(ModelView& world, Model& model) const override;
  void place(ModelView& world, Model& model, const EntityState& state) const override;
  void reset(ModelView& world, Model& model) const override;
  EntityState state(const Scene& world, const Model& model) const override;
  Pose linkPose(const Scene& world, const Model& model, int link) const override;
  void reweigh(ContactView& world, Model& model, double added) const override;
  bool push(ContactView& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  /// Returns one body for the robot with its load, which slides and turns on the floor plane.
  ModelBodies build(const Scene& world, const Model& model) const override;
  bool isActivatedWhenNear() const override { return true; }
  void activated(RobotView& world, Model& model) const override;
  void deactivated(RobotView& world, Model& model) const override;
  bool followsBodies(const Model& /*model*/) const override { return false; }
  bool drivesJoints() const override { return true; }
  bool reportsCollisions() const override { return true; }
  int robot(const Scene& /*world*/, const Model& model) const override { return model.index; }
  int group(const Model& model) const override { return model.index; }
};

/// Returns whether the description is that of a Kiva robot: it names the motion plugin.
bool isRobot(const ModelDescription& description);

}  // namespace kiva
