// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <vector>

#include "warehouse_layout/register_plugin.h"

namespace warehouse {

/// A shared library of classes registered with WAREHOUSE_ADD_PLUGIN. It stays loaded until the
/// program ends, as objects of its classes may live that long.
class PluginLibrary {
 public:
  /// Throws std::runtime_error with the dynamic linker's reason if the file at `path` can't be
  /// loaded.
  explicit PluginLibrary(const std::string& path);

  /// Returns the names of its classes, separated by commas, each with its interface; empty without
  /// classes.
  std::string contents() const;

  /// Returns the class of that name, ignoring namespaces in either; null if there is none.
  const PluginClass* find(const std::string& name) const;

  /// Returns the first class with that interface; null if there is none.
  template <typename Interface>
  const PluginClass* first() const {
    for (const PluginClass* plugin : classes_) {
      if (is<Interface>(*plugin)) return plugin;
    }
    return nullptr;
  }

  template <typename Interface>
  static bool is(const PluginClass& plugin) {
    return *plugin.type == typeid(Interface);
  }

  /// Returns a new object of a class with that interface.
  template <typename Interface>
  static std::shared_ptr<Interface> make(const PluginClass& plugin) {
    return std::shared_ptr<Interface>(static_cast<Interface*>(plugin.make()));
  }

 private:
  std::vector<const PluginClass*> classes_;  // in the order in which they were registered
};

}  // namespace warehouse
