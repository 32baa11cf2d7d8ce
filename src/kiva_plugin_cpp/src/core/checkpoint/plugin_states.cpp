// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/plugin_states.h"

#include <memory>

#include "core/models/models.h"
#include "core/models/user_plugins.h"
#include "core/state/views/fleet_plugin.h"

namespace kiva {
namespace {

using PluginList = std::vector<std::shared_ptr<Plugin>>;
using Descriptions = std::vector<PluginDescription>;

void save(const std::string& model, const PluginList& plugins, std::vector<PluginState>* out) {
  for (std::size_t i = 0; i < plugins.size(); ++i) {
    out->push_back({model, static_cast<int>(i), plugins[i]->save()});
  }
}

/// Returns the descriptions of users' plugins.
Descriptions usersOwn(const WorldState& world, const Descriptions& all) {
  Descriptions own;
  for (const PluginDescription& plugin : all) {
    if (!findFleetPlugin(world.plugins, plugin.filename)) own.push_back(plugin);
  }
  return own;
}

/// Returns those of a model and of its sensors.
Descriptions usersOwn(const WorldState& world, const Model& model) {
  Descriptions own = usersOwn(world, model.description->plugins);
  for (const SensorDescription& sensor : model.description->sensors) {
    own.insert(own.end(), sensor.plugins.begin(), sensor.plugins.end());
  }
  return own;
}

bool isSame(const Descriptions& a, const Descriptions& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].filename != b[i].filename) return false;
    if (a[i].parameters.values() != b[i].parameters.values()) return false;
  }
  return true;
}

void adoptModel(WorldState& world, const WorldState& before, Model& model) {
  const Model* known = before.models.find(model.name);
  const bool same = known && known->robot_namespace == model.robot_namespace &&
                    isSame(usersOwn(world, model), usersOwn(before, *known));
  if (same) {
    model.plugins = known->plugins;
  } else {
    loadPlugins(world.view, model);
  }
}

void adoptWorld(WorldState& world, const WorldState& before) {
  const Descriptions& own = world.plugins.world_descriptions;
  if (isSame(own, before.plugins.world_descriptions)) {
    world.plugins.world = before.plugins.world;
    return;
  }
  for (const PluginDescription& plugin : own) {
    auto loaded = loadPlugin(world.view, "", plugin.filename, plugin.parameters, nullptr);
    if (loaded) world.plugins.world.push_back(std::move(loaded));
  }
}

}  // namespace

std::vector<PluginState> savePlugins(const WorldState& world) {
  std::vector<PluginState> states;
  save("", world.plugins.world, &states);
  for (int slot : world.models.with_plugins) {
    save(world.models[slot]->name, world.models[slot]->plugins, &states);
  }
  return states;
}

void adoptPlugins(WorldState& world, const WorldState& before) {
  // Drops commands that a plugin posts when it is loaded: it posted them long ago.
  const auto pending = world.inbox.pending;
  const auto events = world.log.events;
  const auto status_changes = world.log.status_changes;
  adoptWorld(world, before);
  for (int slot : world.models.with_plugins) adoptModel(world, before, *world.models[slot]);
  world.inbox.pending = pending;
  world.log.events = events;
  world.log.status_changes = status_changes;
}

void restorePlugins(WorldState& world, const std::vector<PluginState>& states) {
  for (const PluginState& saved : states) {
    const Model* model = saved.model.empty() ? nullptr : world.models.find(saved.model);
    const PluginList& plugins = model ? model->plugins : world.plugins.world;
    const auto index = static_cast<std::size_t>(saved.index);
    if (index < plugins.size()) plugins[index]->restore(*world.plugins.owner, saved.state);
  }
}

}  // namespace kiva
