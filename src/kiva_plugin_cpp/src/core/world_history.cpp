// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/checkpoint.h"
#include "core/checkpoint/plugin_states.h"
#include "core/checkpoint/rebuild.h"
#include "core/parallel/workers.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"
#include "plugins/plugin_table.h"

namespace kiva {

std::string World::checkpoint() const { return kiva::checkpoint(*state_); }
std::uint64_t World::stateHash() const { return kiva::stateHash(*state_); }

void World::restore(const std::string& checkpoint) {
  if (returnTo(*state_, checkpoint)) return;
  Restored next = readCheckpoint(checkpoint);
  const std::vector<PluginState> before = savePlugins(*state_);
  next.world->plugins.owner = this;
  next.world->settings.options.plugins = state_->settings.options.plugins;
  next.world->settings.options.threads = state_->settings.options.threads;
  next.world->schedule.workers = state_->schedule.workers;
  next.world->shadows = state_->shadows;
  next.world->log.warned = state_->log.warned;
  next.world->plugins.fleet = makeFleetPlugins();
  next.world->models.revision = state_->models.revision + 1;
  next.world->storage.revision = state_->storage.revision + 1;
  state_.swap(next.world);
  try {
    adoptPlugins(*state_, *next.world);
    restorePlugins(*state_, next.plugins);
  } catch (...) {
    state_.swap(next.world);
    restorePlugins(*state_, before);
    throw;
  }
}

std::vector<Event> World::takeEvents() {
  std::vector<Event> out;
  out.swap(state_->log.events);
  state_->log.events.reserve(out.size());  // room for as many again
  return out;
}

std::vector<StatusChange> World::takeStatusChanges() {
  std::vector<StatusChange> out;
  out.swap(state_->log.status_changes);
  return out;
}

void World::warn(const std::string& warning) { state_->log.warn(warning, warning); }

std::vector<std::string> World::takeWarnings() {
  std::vector<std::string> out;
  out.swap(state_->log.warnings);
  return out;
}

}  // namespace kiva
