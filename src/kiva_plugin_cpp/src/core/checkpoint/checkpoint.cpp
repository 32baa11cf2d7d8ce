// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/checkpoint.h"

#include <algorithm>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/checkpoint/consistency.h"
#include "core/checkpoint/describe.h"
#include "core/checkpoint/rebuild.h"
#include "core/checkpoint/seal.h"
#include "core/disturbances/batteries.h"
#include "core/disturbances/failures.h"
#include "core/people/protective_fields.h"
#include "core/sensing/scans.h"
#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

/// The models' descriptions, each once, whatever the number of models that share it.
struct DescriptionTable {
  std::vector<std::shared_ptr<const ModelDescription>> descriptions;
  std::vector<std::int32_t> of_slot;  // -1 = no model
};

DescriptionTable tableOf(const WorldState& world) {
  DescriptionTable table;
  std::map<const ModelDescription*, std::int32_t>
      index;  // for look-up only, since its order depends on addresses
  for (const auto& model : world.models) {
    if (!model) {
      table.of_slot.push_back(-1);
      continue;
    }
    const auto next = static_cast<std::int32_t>(table.descriptions.size());
    const auto [at, is_new] = index.try_emplace(model->description.get(), next);
    if (is_new) table.descriptions.push_back(model->description);
    table.of_slot.push_back(at->second);
  }
  return table;
}

void makeModels(WorldState& world, const DescriptionTable& table) {
  world.models.slots.reserve(table.of_slot.size());
  for (std::size_t slot = 0; slot < table.of_slot.size(); ++slot) {
    const std::int32_t description = table.of_slot[slot];
    if (description >= static_cast<std::int32_t>(table.descriptions.size())) {
      throw ArchiveError("there is no such description", "of_slot[" + std::to_string(slot) + "]");
    }
    world.models.slots.push_back(description < 0 ? nullptr : std::make_unique<Model>());
    if (description < 0) continue;
    world.models.slots.back()->description = table.descriptions[description];
    world.models.slots.back()->slot = static_cast<int>(world.models.size()) - 1;
  }
}

/// Describes the models of a world, and all that does not change from step to step.
template <class A>
void describeSetting(A& a, WorldState& world) {
  DescriptionTable table;
  if constexpr (!A::kReads) table = tableOf(world);
  FIELDS(table.descriptions, table.of_slot);
  if constexpr (A::kReads) makeModels(world, table);
  FIELDS(world.settings.name, world.settings.gravity, world.settings.options,
         world.settings.realism, world.settings.realism_of_models,
         within(world.clock.dt, kLeastStep, kMostStep),
         within(world.settings.grid_spacing, kLeastGridSpacing, kMostGridSpacing),
         world.floor.extent, within(world.floor.friction, 0, 1e6), world.floor.patches);
  if constexpr (A::kReads) world.fleet.applyRealism(world.settings.realism, world.clock.dt);
  FIELDS(world.models.free_slots, world.models.next_serial, world.plugins.world_descriptions);
}

/// Returns whether a model has a state of its own; what is static or lies on a unit has none.
bool hasState(const Model& model) {
  return model.owner->isActivatedWhenNear() || (model.in_physics && !model.isStatic());
}

/// Describes all that changes from step to step.
template <class A>
void describeMotion(A& a, WorldState& world, PhysicsState& physics) {
  FIELDS(world.clock.steps, world.clock.total_steps, world.clock.dt_since,
         world.clock.dt_since_time);
  for (auto& model : world.models) {
    if (model && (!std::is_same_v<A, Hasher> || hasState(*model))) FIELDS(*model);
  }
  FIELDS(world.fleet, world.storage.units, world.storage.items);
  if (!std::is_same_v<A, Hasher>) FIELDS(within(world.fleet.mode, 0, kMostMode));
  if (!std::is_same_v<A, Hasher> || !world.fleet.steerings.empty()) FIELDS(world.fleet.steerings);
  if (world.fleet.localises) FIELDS(world.fleet.localisation);
  if (world.settings.realism.loads.enabled) FIELDS(world.fleet.sway, world.fallen.items);
  if (!world.fleet.lag.isNone()) FIELDS(world.fleet.command_speed);
  FIELDS(world.models.bodies, world.models.with_plugins, world.models.activated,
         world.contact_log.touching, world.scans.due, world.scans.sighted,
         world.contact_log.crashes);
  FIELDS(within(world.fleet.fastest, 0, 1e4), world.external_inputs);
  FIELDS(physics);
  if (!std::is_same_v<A, Hasher> || mayFail(world.settings.realism, world.failures))
    FIELDS(world.failures);
  if (world.settings.realism.energy.enabled) FIELDS(world.fleet.battery);
  if (world.settings.realism.radio.delaysReports()) {
    FIELDS(world.fleet.heard, world.report_link.messages, world.report_link.sent,
           world.report_link.changed);
  }
  if (!std::is_same_v<A, Hasher> || world.people.slowsRobots()) {
    FIELDS(world.people.walkers, world.people.field_was_occupied, world.people.curtains,
           within(world.fleet.allowed_speed, 0, kEndless), within(world.fleet.curtained, 0, 1));
  }
}

/// Gives each command of the kind kFollow its path. Throws ArchiveError.
void pairUp(std::deque<Command> commands, std::deque<FollowPath> paths, Inbox* inbox) {
  const auto follow = static_cast<std::size_t>(
      std::count_if(commands.begin(), commands.end(),
                    [](const Command& command) { return command.kind == Command::Kind::kFollow; }));
  if (follow != paths.size()) {
    throw ArchiveError("there is one for every command that follows one",
                       "paths[" + std::to_string(paths.size()) + "]");
  }
  for (const Command& command : commands) {
    inbox->pending.push_back({command, {}});
    if (command.kind != Command::Kind::kFollow) continue;
    inbox->pending.back().path = std::move(paths.front());
    paths.pop_front();
  }
}

/// Describes pending commands, and apart from them the paths that some of them stand for.
template <class A>
void describeInbox(A& a, Inbox& inbox) {
  std::deque<Command> commands;
  std::deque<FollowPath> paths;
  for (const PendingCommand& pending : inbox.pending) {
    commands.push_back(pending.command);
    if (pending.command.kind == Command::Kind::kFollow) paths.push_back(pending.path);
  }
  FIELDS(inbox.last_command, commands, paths);
  if constexpr (A::kReads) pairUp(std::move(commands), std::move(paths), &inbox);
}

/// Describes messages to and from the world.
template <class A>
void describeQueues(A& a, WorldState& world) {
  describeInbox(a, world.inbox);
  FIELDS(world.command_link.messages, world.command_link.sent, world.log.events,
         world.log.status_changes);
}

void indexNames(WorldState& world) {
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    if (world.models[slot])
      world.models.slot_of_name[world.models[slot]->name] = static_cast<int>(slot);
  }
  for (std::size_t i = 0; i < world.storage.units.size(); ++i) {
    world.storage.unit_of_id[world.storage.units[i].id] = static_cast<int>(i);
  }
}

/// Derives the state that a checkpoint leaves out: names and indices of items, rays of robots, …
void deriveRest(WorldState& world) {
  for (Item& item : world.storage.items) item.name = world.models[item.model]->name;
  world.storage.indexItems();
  for (Robot& robot : world.fleet.robots) setRays(world.scans, &robot);
  restoreDefects(world.fleet, world.settings.realism, world.failures);
  restoreCharge(world.fleet, world.settings.realism.energy);
  world.fleet.sway.resize(world.fleet.size());
  world.fleet.heard.resize(world.fleet.size());
  world.fleet.command_speed.resize(world.fleet.size());
  world.fleet.count_at.clear();
  for (int i = 0; i < world.fleet.size(); ++i) {
    world.fleet.count_at.push_back(nextCount(world.view, i));
  }
}

/// Returns the content of a checkpoint if the world was restored from this very checkpoint, nothing
/// static has moved since, and no plugin might refuse. Damaged bytes have another hash.
std::optional<Reader> readOrigin(const WorldState& world, const std::string& bytes) {
  const bool has_plugins = !world.plugins.world.empty() || !world.models.with_plugins.empty();
  const bool stands = world.origin.fixtures == world.physics.fixtureChanges();
  if (has_plugins || world.origin.hash == 0 || !stands) return std::nullopt;
  try {
    const Content content = opened(bytes);
    if (content.hash == world.origin.hash) return content.reader;
  } catch (const ArchiveError&) {  // reported by readCheckpoint()
  }
  return std::nullopt;
}

/// Reads the checkpoint's settings; returns whether they are those of the world.
bool readSameSetting(Reader& reader, WorldState& world) {
  Comparer now(reader.at, reader.end);
  describeSetting(now, world);
  reader.at = now.at;
  return now.is_same;
}

/// Clears state that only some realism describes, and events that clients have not taken.
void forget(WorldState& world) {
  FleetState& f = world.fleet;
  f.battery.clear();
  f.sway.clear();
  f.heard.clear();
  f.command_speed.clear();
  f.localisation.clear();
  world.fallen = FallenItems();
  world.report_link = ReportLink();
  world.inbox.pending.clear();
  world.schedule.stepped_singly.clear();
  world.log.warnings.clear();
}

Restored read(const std::string& bytes) {
  auto [reader, hash] = opened(bytes);
  Restored out{std::make_unique<WorldState>(WorldDescription(), WorldOptions()), {}};
  PhysicsState physics;
  describeSetting(reader, *out.world);
  describeMotion(reader, *out.world, physics);
  describeQueues(reader, *out.world);
  reader(out.plugins);
  if (reader.left() > 0) throw ArchiveError("it has bytes left over");
  checkConsistent(*out.world, physics);
  indexNames(*out.world);
  deriveRest(*out.world);
  out.world->origin.hash = hash;
  rebuild(*out.world, physics);
  return out;
}

}  // namespace

std::string checkpoint(const WorldState& saved) {
  auto& world = const_cast<WorldState&>(saved);  // describing changes nothing, except by a reader
  PhysicsState physics = readPhysics(world);
  std::vector<PluginState> plugins = savePlugins(world);
  Writer writer;
  writer.bytes.reserve(1 << 22);
  describeSetting(writer, world);
  describeMotion(writer, world, physics);
  describeQueues(writer, world);
  writer(plugins);
  return sealed(writer.bytes);
}

Restored readCheckpoint(const std::string& bytes) {
  try {
    return read(bytes);
  } catch (const std::exception& error) {
    throw CheckpointError(std::string("not a checkpoint that can be restored: ") + error.what());
  }
}

bool returnTo(WorldState& world, const std::string& bytes) {
  std::optional<Reader> reader = readOrigin(world, bytes);
  if (!reader || !readSameSetting(*reader, world)) return false;
  const std::vector<Standing> before = clearPhysics(world);
  forget(world);
  PhysicsState physics;
  describeMotion(*reader, world, physics);
  describeQueues(*reader, world);
  deriveRest(world);
  rebuildMovable(world, physics, before);
  ++world.models.revision;
  ++world.storage.revision;
  return true;
}

std::uint64_t stateHash(const WorldState& world) {
  Hasher hasher;
  PhysicsState physics = readPhysics(world);
  physics.contacts.clear();  // the next step would drop some, and a restored world lacks these
  // Describing changes nothing, except by a reader.
  describeMotion(hasher, const_cast<WorldState&>(world), physics);
  std::vector<PluginState> plugins = savePlugins(world);
  hasher(plugins);
  return hasher.hash;
}

}  // namespace kiva
