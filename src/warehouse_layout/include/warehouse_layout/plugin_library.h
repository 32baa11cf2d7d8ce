// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <vector>

#include "warehouse_layout/register_plugin.h"

namespace warehouse {

/// A shared library of classes that were registered with WAREHOUSE_ADD_PLUGIN. It stays loaded
/// until the program ends: objects of its classes may live as long.
class PluginLibrary {
 public:
  /// Throws std::runtime_error with the dynamic linker's reason if the file at `path` can't be
  /// loaded.
  explicit PluginLibrary(const std::string& path);

  /// The names of the classes in it, separated by commas, each with its interface; empty: none.
  std::string contents() const;

  /// The class of that name, namespaces left out in either; null if there is none.
  const PluginClass* find(const std::string& name) const;

  /// The first class for that interface; null if there is none.
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

  /// A new object of a class that is for that interface.
  template <typename Interface>
  static std::shared_ptr<Interface> make(const PluginClass& plugin) {
    return std::shared_ptr<Interface>(static_cast<Interface*>(plugin.make()));
  }

 private:
  std::vector<const PluginClass*> classes_;  // in the order in which they were registered
};

}  // namespace warehouse
