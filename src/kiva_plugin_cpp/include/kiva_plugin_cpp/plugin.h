// SPDX-License-Identifier: Apache-2.0
//
// A user's own plugin: derive one class from Plugin in a library, register it, and name the
// library's file in an SDF `<plugin filename="lib….so">` of a model or a world:
//
//   #include "warehouse_layout/register_plugin.h"
//   class Mine : public kiva::Plugin { … };
//   WAREHOUSE_ADD_PLUGIN(Mine, kiva::Plugin)
//
// Libraries are searched by name in the folders of KIVA_PLUGIN_PATH, then in those of the
// workspaces that were sourced (lib/ in CMAKE_PREFIX_PATH). One that is in neither is left out with
// a warning.
#pragma once

#include <string>

#include "kiva_plugin_cpp/parameters.h"

namespace kiva {

class World;

/// A plugin commands in beforeStep and observes in afterStep.
class Plugin {
 public:
  virtual ~Plugin() = default;

  /// Called once, when its model stands in the world. `model` is that model's name, empty for a
  /// plugin of the world. Throw to refuse the model; keys of `parameters` that were not read refuse
  /// it too.
  virtual void load(World& world, const std::string& model, const Parameters& parameters) = 0;

  /// Called before each physics step of `dt` seconds: commands, applies forces.
  virtual void beforeStep(World& /*world*/, double /*dt*/) {}

  /// Called after it: observes.
  virtual void afterStep(const World& /*world*/, double /*dt*/) {}

  /// Returns the plugin's state as bytes, for checkpoints.
  virtual std::string save() const { return ""; }
  /// Restores a state of save(), once all models stand as they did then. A model that was gone
  /// meanwhile comes back with a new plugin: load() is called before, and what it posts is dropped.
  virtual void restore(World& /*world*/, const std::string& /*state*/) {}

  /// Called after the world was reset, perhaps with its time.
  virtual void reset(World& /*world*/) {}

  /// Whether what it throws, and parameters that were not read, refuse the model; else they are a
  /// warning, and a plugin that threw is left out.
  virtual bool isStrict() const { return true; }
};

}  // namespace kiva
