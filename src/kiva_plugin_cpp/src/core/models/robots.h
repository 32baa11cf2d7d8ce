// SPDX-License-Identifier: Apache-2.0
//
// Kiva robots: in arrays as long as they are alone, see contact/activation.h.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

class Robots : public ModelOwner {
 public:
  void add(WorldState& world, Model& model) const override;
  void remove(WorldState& world, Model& model) const override;
  void place(WorldState& world, Model& model, const EntityState& state) const override;
  void reset(WorldState& world, Model& model) const override;
  EntityState state(const WorldState& world, const Model& model) const override;
  Pose linkPose(const WorldState& world, const Model& model, int link) const override;
  void reweigh(WorldState& world, Model& model, double added) const override;
  bool push(WorldState& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  /// With its load one body that slides and turns on the floor plane.
  ModelBodies build(const WorldState& world, const Model& model) const override;
  bool isActivatedWhenNear() const override { return true; }
  void activated(WorldState& world, Model& model) const override;
  void deactivated(WorldState& world, Model& model) const override;
  bool followsBodies(const Model& /*model*/) const override { return false; }
  bool drivesJoints() const override { return true; }
  bool tellsCollisions() const override { return true; }
  int robot(const WorldState& /*world*/, const Model& model) const override { return model.index; }
  int group(const Model& model) const override { return model.index; }
};

/// Whether the description is a Kiva robot's: it names the motion plugin.
bool isRobot(const ModelDescription& description);

}  // namespace kiva
