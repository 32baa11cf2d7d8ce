// SPDX-License-Identifier: Apache-2.0
//
// Kiva robots: in arrays as long as they are alone, see contact/activation.h.
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
  void reweigh(ModelView& world, Model& model, double added) const override;
  bool push(ContactView& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  /// With its load one body that slides and turns on the floor plane.
  ModelBodies build(const Scene& world, const Model& model) const override;
  bool isActivatedWhenNear() const override { return true; }
  void activated(ContactView& world, Model& model) const override;
  void deactivated(ContactView& world, Model& model) const override;
  bool followsBodies(const Model& /*model*/) const override { return false; }
  bool drivesJoints() const override { return true; }
  bool tellsCollisions() const override { return true; }
  int robot(const Scene& /*world*/, const Model& model) const override { return model.index; }
  int group(const Model& model) const override { return model.index; }
};

/// Returns whether the description is a Kiva robot's: it names the motion plugin.
bool isRobot(const ModelDescription& description);

}  // namespace kiva
