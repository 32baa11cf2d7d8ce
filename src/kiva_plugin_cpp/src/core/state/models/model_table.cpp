// SPDX-License-Identifier: Apache-2.0
#include "core/state/models/model_table.h"

#include <algorithm>
#include <utility>

namespace kiva {

std::vector<int> ModelTable::inOrder() const {
  std::vector<int> out;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i]) out.push_back(static_cast<int>(i));
  }
  std::sort(out.begin(), out.end(),
            [this](int a, int b) { return slots[a]->serial < slots[b]->serial; });
  return out;
}

Model& ModelTable::add(std::unique_ptr<Model> model) {
  int slot = static_cast<int>(slots.size());
  if (free_slots.empty()) {
    slots.emplace_back();
  } else {
    slot = free_slots.back();
    free_slots.pop_back();
  }
  model->slot = slot;
  model->serial = next_serial++;
  slot_of_name[model->name] = slot;
  slots[slot] = std::move(model);
  return *slots[slot];
}

void ModelTable::remove(int slot) {
  slot_of_name.erase(slots[slot]->name);
  slots[slot].reset();
  free_slots.push_back(slot);
}

}  // namespace kiva
