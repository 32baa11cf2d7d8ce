// SPDX-License-Identifier: Apache-2.0
//
// Items: fixed to the storage unit on which they were spawned, or bodies of their own without one.
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
  void reweigh(ContactView& world, Model& model, double added) const override;
  bool push(ContactView& world, Model& model, int link, const Vector3& at, const Vector3& force,
            const Vector3& torque) const override;
  /// Returns kTaken for a fallen item, which is to be picked up. Other loose items are meant to lie
  /// there.
  std::uint8_t occupies(const Scene& world, const Model& model) const override;
  int group(const Model& /*model*/) const override { return -1; }
  bool isTracked() const override { return true; }
};

/// Drops the item over the edge of its unit: it becomes a body of its own.
void fallOff(ModelView& world, Model& item, const EntityState& state);
/// Puts the item back into its place on that unit.
void putBack(ModelView& world, Model& item, const Model& unit);
/// Removes a model from the fallen items.
void forgetFallen(FallenItems& fallen, int slot);
/// Puts all fallen items back on their units, without events.
void putAllBack(ModelView& world);

}  // namespace kiva
