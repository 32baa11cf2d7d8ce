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

  /// Called once, when the plugin's model stands in the world. `model` is the name of that model,
  /// empty for a plugin of the world. To refuse the model, throw. A key of `parameters` that was
  /// not read refuses the model, too.
  virtual void load(World& world, const std::string& model, const Parameters& parameters) = 0;

  /// Called before each physics step of `dt` seconds, to command and to apply forces.
  virtual void beforeStep(World& /*world*/, double /*dt*/) {}

  /// Called after each physics step, to observe.
  virtual void afterStep(const World& /*world*/, double /*dt*/) {}

  /// Returns the plugin's state as bytes, for checkpoints.
  virtual std::string save() const { return ""; }
  /// Restores a state of save(), once all models stand as they did then. For a model that had been
  /// removed, load() is called first on a new plugin; commands posted there are dropped.
  virtual void restore(World& /*world*/, const std::string& /*state*/) {}

  /// Called after the world was reset, with or without its time.
  virtual void reset(World& /*world*/) {}

  /// Returns whether errors and unread parameters refuse the model. Otherwise they are warnings,
  /// and a plugin that threw is left out.
  virtual bool isStrict() const { return true; }
};

}  // namespace kiva
