// SPDX-License-Identifier: Apache-2.0
//
// Items: fixed to the storage unit where they were put, or bodies of their own where none was.
#pragma once

#include "core/models/ordinary_models.h"

namespace kiva {

class Items : public OrdinaryModels {
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
  /// One that fell is to be picked up; where others lie loose, somebody wants them there.
  std::uint8_t occupies(const Scene& world, const Model& model) const override;
  int group(const Model& /*model*/) const override { return -1; }
  bool isTracked() const override { return true; }
};

/// The item slides over the edge of its unit, and is a body of its own from then on.
void fallOff(ModelView& world, Model& item, const EntityState& state);
/// It is in its place on that unit again.
void putBack(ModelView& world, Model& item, const Model& unit);
/// What is known of those that fell, without a model that is going.
void forgetFallen(FallenItems& fallen, int slot);
/// All that fell are back on their units, and nobody is told.
void putAllBack(ModelView& world);

}  // namespace kiva
