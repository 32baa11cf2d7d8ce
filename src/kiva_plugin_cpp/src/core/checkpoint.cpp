// SPDX-License-Identifier: Apache-2.0
#include "checkpoint.h"

#include <algorithm>
#include <map>
#include <type_traits>
#include <utility>

#include "describe.h"
#include "renewal.h"
#include "sensing.h"

namespace kiva {
namespace {

constexpr char kMagic[9] = "KIVAWRLD";
constexpr std::uint32_t kVersion = 3;

/// The models' descriptions, each once however many share it.
struct DescriptionTable {
  std::vector<ModelDescription> descriptions;
  std::vector<std::int32_t> of_slot;  // -1 = no model
};

DescriptionTable tableOf(const Parts& parts) {
  DescriptionTable table;
  std::map<const ModelDescription*, std::int32_t> index;  // for looking up: its order is none
  for (const auto& model : parts.models) {
    if (!model) {
      table.of_slot.push_back(-1);
      continue;
    }
    const ModelDescription* description = model->description.get();
    const auto next = static_cast<std::int32_t>(table.descriptions.size());
    const auto [at, is_new] = index.try_emplace(description, next);
    if (is_new) table.descriptions.push_back(*description);
    table.of_slot.push_back(at->second);
  }
  return table;
}

void makeModels(Parts& parts, DescriptionTable table) {
  std::vector<std::shared_ptr<const ModelDescription>> shared;
  for (ModelDescription& d : table.descriptions) {
    shared.push_back(std::make_shared<ModelDescription>(std::move(d)));
  }
  for (std::int32_t description : table.of_slot) {
    parts.models.push_back(description < 0 ? nullptr : std::make_unique<Model>());
    if (description >= 0) parts.models.back()->description = shared.at(description);
  }
}

/// What stands in the world, and what it is made of.
template <class A>
void describeSetting(A& a, Parts& parts) {
  DescriptionTable table;
  if constexpr (!A::kReads) table = tableOf(parts);
  a(table.descriptions, table.of_slot);
  if constexpr (A::kReads) makeModels(parts, std::move(table));
  a(parts.name, parts.gravity, parts.options, parts.dt, parts.grid_spacing, parts.floor,
    parts.floor_friction);
  a(parts.free_slots, parts.next_serial, parts.world_plugin_descriptions);
}

/// Whether a model has a state of its own; what is static or lies on a unit has none.
bool hasState(const Model& model) {
  return model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit ||
         (model.in_physics && !model.isStatic());
}

/// What changes from step to step.
template <class A>
void describeMotion(A& a, Parts& parts, PhysicsState& physics) {
  a(parts.steps, parts.total_steps, parts.dt_since, parts.dt_since_time);
  for (auto& model : parts.models) {
    if (model && (!std::is_same_v<A, Hasher> || hasState(*model))) a(*model);
  }
  a(parts.fleet, parts.units, parts.items);
  a(parts.bodies, parts.models_with_plugins, parts.engaged, parts.touching, parts.scans_due);
  a(parts.top_speed, parts.interventions);
  a(physics);
}

/// What is on its way in or out.
template <class A>
void describeQueues(A& a, Parts& parts) {
  a(parts.commands, parts.events, parts.status_changes);
}

void indexModels(Parts& parts) {
  for (std::size_t slot = 0; slot < parts.models.size(); ++slot) {
    if (parts.models[slot]) parts.slot_of_name[parts.models[slot]->name] = static_cast<int>(slot);
  }
  for (std::size_t i = 0; i < parts.units.size(); ++i) {
    parts.unit_of_id[parts.units[i].id] = static_cast<int>(i);
  }
  for (Item& item : parts.items) item.name = parts.models.at(item.model)->name;
  for (Robot& robot : parts.fleet.robots) setRays(parts, &robot);
}

struct Header {
  std::uint64_t size = 0, hash = 0;
};

std::string sealed(const std::string& content) {
  Writer header;
  std::uint32_t version = kVersion;
  std::uint64_t size = content.size(), hash = hashBytes(kVersion, content.data(), content.size());
  header.bytes = kMagic;
  header(version, size, hash);
  return header.bytes + content;
}

/// What is under the seal. Throws ArchiveError if it is broken.
Reader opened(const std::string& bytes) {
  Reader reader(bytes);
  char magic[8];
  std::uint32_t version;
  std::uint64_t size, hash;
  reader(magic);
  if (std::memcmp(magic, kMagic, 8) != 0) throw ArchiveError("these bytes are none");
  reader(version);
  if (version != kVersion) {
    throw ArchiveError("it has format " + std::to_string(version) + ", and this is format " +
                       std::to_string(kVersion));
  }
  reader(size, hash);
  if (size != reader.left()) {
    throw ArchiveError("it has " + std::to_string(reader.left()) + " bytes of content where " +
                       std::to_string(size) + " were expected");
  }
  if (hashBytes(kVersion, reader.at, size) != hash) throw ArchiveError("its bytes are damaged");
  return reader;
}

Restored read(const std::string& bytes) {
  Reader reader = opened(bytes);
  Restored out{std::make_unique<Parts>(WorldDescription(), WorldOptions()), {}};
  PhysicsState physics;
  describeSetting(reader, *out.parts);
  describeMotion(reader, *out.parts, physics);
  describeQueues(reader, *out.parts);
  reader(out.plugins);
  if (reader.left() > 0) throw ArchiveError("it has bytes left over");
  indexModels(*out.parts);
  renew(*out.parts, physics);
  return out;
}

}  // namespace

std::string checkpoint(Parts& parts) {
  PhysicsState physics = readPhysics(parts);
  std::vector<PluginState> plugins = savePlugins(parts);
  Writer writer;
  writer.bytes.reserve(1 << 22);
  describeSetting(writer, parts);
  describeMotion(writer, parts, physics);
  describeQueues(writer, parts);
  writer(plugins);
  renew(parts, physics);
  return sealed(writer.bytes);
}

Restored readCheckpoint(const std::string& bytes) {
  try {
    return read(bytes);
  } catch (const std::exception& error) {
    throw CheckpointError(std::string("not a checkpoint that can be restored: ") + error.what());
  }
}

std::uint64_t stateHash(const Parts& parts) {
  Hasher hasher;
  PhysicsState physics = readPhysics(parts);
  physics.contacts.clear();  // their order has no meaning
  // Nor has it a meaning which slots are free.
  auto& bodies = physics.bodies;
  const auto is_empty = [](const std::vector<BodyState>& states) { return states.empty(); };
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(), is_empty), bodies.end());
  // Describing changes nothing unless it reads.
  describeMotion(hasher, const_cast<Parts&>(parts), physics);
  std::vector<PluginState> plugins = savePlugins(parts);
  hasher(plugins);
  return hasher.hash;
}

}  // namespace kiva
