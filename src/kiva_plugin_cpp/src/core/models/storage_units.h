// SPDX-License-Identifier: Apache-2.0
//
// Storage units: they stand on their legs, lie on the floor, or rest on a robot.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

class StorageUnits : public ModelOwner {
 public:
  void add(ModelView& world, Model& model) const override;
  void remove(ModelView& world, Model& model) const override;
  std::vector<int> passengers(const Scene& world, const Model& model) const override;
  void place(ModelView& world, Model& model, const EntityState& state) const override;
  void reset(ModelView& world, Model& model) const override;
  EntityState state(const Scene& world, const Model& model) const override;
  Pose linkPose(const Scene& world, const Model& model, int link) const override;
  void reweigh(ContactView& world, Model& model, double added) const override;
  bool push(ContactView& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  ModelBodies build(const Scene& world, const Model& model) const override;
  bool isActivatedWhenNear() const override { return true; }
  bool mayBeUpright(const Scene& world, const Model& model) const override;
  void deactivated(RobotView& world, Model& model) const override;
  bool mayLeaveBullet(const Scene& world, const Model& model, bool is_alone) const override;
  bool reportsCollisions() const override { return true; }
  void touched(MotionView& world, Model& model) const override;
  int robot(const Scene& world, const Model& model) const override;
  bool stops(const Scene& world, const Model& model, int robot) const override;
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kStorageUnit;
  }
  bool isTracked() const override { return true; }
  bool holdsItems() const override { return true; }
};

}  // namespace kiva
