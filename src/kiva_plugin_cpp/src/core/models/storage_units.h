// SPDX-License-Identifier: Apache-2.0
//
// Storage units: they stand on their legs, lie where they were thrown, or rest on a robot.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

class StorageUnits : public ModelOwner {
 public:
  void add(WorldState& world, Model& model) const override;
  void remove(WorldState& world, Model& model) const override;
  std::vector<int> passengers(const WorldState& world, const Model& model) const override;
  void place(WorldState& world, Model& model, const EntityState& state) const override;
  void reset(WorldState& world, Model& model) const override;
  EntityState state(const WorldState& world, const Model& model) const override;
  Pose linkPose(const WorldState& world, const Model& model, int link) const override;
  void reweigh(WorldState& world, Model& model, double added) const override;
  bool push(WorldState& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  ModelBodies build(const WorldState& world, const Model& model) const override;
  bool isActivatedWhenNear() const override { return true; }
  bool mayBeUpright(const WorldState& world, const Model& model) const override;
  void deactivated(WorldState& world, Model& model) const override;
  bool mayLeaveBullet(const WorldState& world, const Model& model, bool is_alone) const override;
  bool tellsCollisions() const override { return true; }
  void touched(WorldState& world, Model& model) const override;
  int robot(const WorldState& world, const Model& model) const override;
  bool stops(const WorldState& world, const Model& model, int robot) const override;
  std::uint8_t occupies(const WorldState& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kStorageUnit;
  }
  bool isTracked() const override { return true; }
  bool holdsItems() const override { return true; }
};

}  // namespace kiva
