// SPDX-License-Identifier: Apache-2.0
//
// Items: fixed to the storage unit where they were put, or bodies of their own where none was.
#pragma once

#include "core/models/ordinary_models.h"

namespace kiva {

class Items : public OrdinaryModels {
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
  std::uint8_t occupies() const override { return Occupancy::kFree; }
  int group(const Model& /*model*/) const override { return -1; }
  bool isTracked() const override { return true; }
};

}  // namespace kiva
