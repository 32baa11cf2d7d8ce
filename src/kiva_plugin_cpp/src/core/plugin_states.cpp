// SPDX-License-Identifier: Apache-2.0
#include "plugin_states.h"

#include <memory>

#include "../plugins/fleet_plugin.h"
#include "models.h"
#include "user_plugins.h"

namespace kiva {
namespace {

using Plugins = std::vector<std::shared_ptr<Plugin>>;
using Descriptions = std::vector<PluginDescription>;

void save(const std::string& model, const Plugins& plugins, std::vector<PluginState>* out) {
  for (std::size_t i = 0; i < plugins.size(); ++i) {
    out->push_back({model, static_cast<int>(i), plugins[i]->save()});
  }
}

/// The descriptions of those that are a user's.
Descriptions usersOwn(const Parts& parts, const Descriptions& all) {
  Descriptions own;
  for (const PluginDescription& plugin : all) {
    if (!findFleetPlugin(parts, plugin.filename)) own.push_back(plugin);
  }
  return own;
}

/// Those of a model and of its sensors.
Descriptions usersOwn(const Parts& parts, const Model& model) {
  Descriptions own = usersOwn(parts, model.description->plugins);
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

void adoptModel(Parts& parts, const Parts& before, Model& model) {
  const Model* known = before.find(model.name);
  const bool same = known && known->robot_namespace == model.robot_namespace &&
                    isSame(usersOwn(parts, model), usersOwn(before, *known));
  if (same) {
    model.plugins = known->plugins;
  } else {
    loadPlugins(parts, model);
  }
}

void adoptWorld(Parts& parts, const Parts& before) {
  const Descriptions& own = parts.world_plugin_descriptions;
  if (isSame(own, before.world_plugin_descriptions)) {
    parts.world_plugins = before.world_plugins;
    return;
  }
  for (const PluginDescription& plugin : own) {
    auto loaded = loadPlugin(parts, "", plugin.filename, plugin.parameters, nullptr);
    if (loaded) parts.world_plugins.push_back(std::move(loaded));
  }
}

}  // namespace

std::vector<PluginState> savePlugins(const Parts& parts) {
  std::vector<PluginState> states;
  save("", parts.world_plugins, &states);
  for (int slot : parts.models_with_plugins) {
    save(parts.models[slot]->name, parts.models[slot]->plugins, &states);
  }
  return states;
}

void adoptPlugins(Parts& parts, const Parts& before) {
  // What a plugin does when it is loaded was done long ago.
  const auto commands = parts.commands;
  const auto events = parts.events;
  const auto status_changes = parts.status_changes;
  adoptWorld(parts, before);
  for (int slot : parts.models_with_plugins) adoptModel(parts, before, *parts.models[slot]);
  parts.commands = commands;
  parts.events = events;
  parts.status_changes = status_changes;
}

void restorePlugins(Parts& parts, const std::vector<PluginState>& states) {
  for (const PluginState& saved : states) {
    const Model* model = saved.model.empty() ? nullptr : parts.find(saved.model);
    const Plugins& plugins = model ? model->plugins : parts.world_plugins;
    const auto index = static_cast<std::size_t>(saved.index);
    if (index < plugins.size()) plugins[index]->restore(*parts.world, saved.state);
  }
}

}  // namespace kiva
