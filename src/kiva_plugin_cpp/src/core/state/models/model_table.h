// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/state/models/model.h"

namespace kiva {

/// The models of a world, by slot.
struct ModelTable {
  std::vector<std::unique_ptr<Model>> slots;  ///< Null where a model was removed.
  std::vector<int> free_slots;
  std::unordered_map<std::string, int> slot_of_name;
  std::uint64_t next_serial = 0;
  std::uint64_t revision = 0;     ///< Counts up whenever a model comes or goes.
  std::vector<int> bodies;        ///< Slots of models with bodies of their own that can move.
  std::vector<int> with_plugins;  ///< Slots.
  std::vector<int> activated;     ///< Slots of robots and storage units that are in Bullet now.

  std::size_t size() const { return slots.size(); }
  auto begin() const { return slots.begin(); }
  auto end() const { return slots.end(); }
  const std::unique_ptr<Model>& operator[](std::size_t slot) const { return slots[slot]; }
  /// Returns the model of that name, or null.
  Model* find(const std::string& name) const {
    const auto at = slot_of_name.find(name);
    return at == slot_of_name.end() ? nullptr : slots[at->second].get();
  }
  Model& of(const Robot& robot) const { return *slots[robot.model]; }
  Model& of(const StorageUnit& unit) const { return *slots[unit.model]; }
  Model& of(const Item& item) const { return *slots[item.model]; }

  /// Returns the slots in the order in which the models arrived.
  std::vector<int> inOrder() const;
  /// Puts the model into a free slot, and numbers it.
  Model& add(std::unique_ptr<Model> model);
  /// Destroys the model in that slot, which becomes free.
  void remove(int slot);
};

}  // namespace kiva
