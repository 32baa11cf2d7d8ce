// SPDX-License-Identifier: Apache-2.0
//
// Models that always are in Bullet: obstacles, belts, floors, and machines with joints.
#pragma once

#include "core/state/views/model_view.h"

namespace kiva {

class OrdinaryModels : public ModelOwner {
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
  ModelBodies build(const Scene& world, const Model& model) const override;
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kTaken;
  }
  int group(const Model& model) const override { return kMaxKivaId + 1 + model.slot; }
};

/// Obstacles up to which robots are meant to drive.
class ConveyorBelts : public OrdinaryModels {
 public:
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kBelt;
  }
  int group(const Model& /*model*/) const override { return -1; }
};

/// Models on which wheels roll. All floors together are the ground on which robots may stand.
class Floors : public OrdinaryModels {
 public:
  bool isFloor() const override { return true; }
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kFree;
  }
};

/// Moves a model's bodies to a pose, with that velocity.
void moveBodies(Model& model, const EntityState& to);
/// Changes the velocity of all bodies as that of one rigid body, so that the canonical link gets
/// `twist`.
void setModelTwist(Model& model, const Twist& twist);
void setBodyState(LinkBody& link, const EntityState& to);

}  // namespace kiva
