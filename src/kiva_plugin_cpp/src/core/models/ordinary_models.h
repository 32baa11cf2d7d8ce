// SPDX-License-Identifier: Apache-2.0
//
// Models that are in Bullet for as long as they exist: obstacles, belts, floors, and machines with
// joints of their own.
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
  void reweigh(ModelView& world, Model& model, double added) const override;
  bool push(ContactView& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  ModelBodies build(const Scene& world, const Model& model) const override;
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kTaken;
  }
  int group(const Model& model) const override { return kMaxKivaId + 1 + model.slot; }
};

/// Obstacles that robots are meant to drive up to.
class ConveyorBelts : public OrdinaryModels {
 public:
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kBelt;
  }
  int group(const Model& /*model*/) const override { return -1; }
};

/// What wheels roll on. All floors together make the ground that robots may stand on.
class Floors : public OrdinaryModels {
 public:
  bool isFloor() const override { return true; }
  std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const override {
    return Occupancy::kFree;
  }
};

/// Puts a model's bodies there, at that velocity.
void moveBodies(Model& model, const EntityState& to);
/// Changes the velocity of all its bodies as that of one rigid body, until its canonical link has
/// this one.
void setModelTwist(Model& model, const Twist& twist);
void setBodyState(LinkBody& link, const EntityState& to);

}  // namespace kiva
