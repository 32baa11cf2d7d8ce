// SPDX-License-Identifier: Apache-2.0
//
// Registers classes of a shared library, which a program may load by name:
//
//   WAREHOUSE_ADD_PLUGIN(Mine, kiva::Plugin)
// at namespace scope, once for each class. The class needs a constructor without arguments.
// PluginLibrary loads it.
#pragma once

#include <typeinfo>

namespace warehouse {

/// A class that a library offers.
struct PluginClass {
  const char* name;            ///< The class as the macro names it.
  const char* interface;       ///< Its interface as the macro names it.
  const std::type_info* type;  ///< The type of that interface.
  void* (*make)();             ///< Makes an object, as a pointer to that interface.
  const PluginClass* next;     ///< The next class of the same library.
};

/// The first class of this library. Hidden, so that each library has a list of its own.
__attribute__((visibility("hidden"))) inline const PluginClass* plugin_classes = nullptr;

/// Adds a class to the list while its library is loaded.
struct PluginRegistration {
  explicit PluginRegistration(PluginClass* added) {
    added->next = plugin_classes;
    plugin_classes = added;
  }
};

/// The symbol of the list for the dynamic linker.
constexpr const char* kPluginClassesSymbol = "warehouse_plugin_classes";

}  // namespace warehouse

extern "C" __attribute__((visibility("default"), used)) inline const warehouse::PluginClass*
warehouse_plugin_classes() {
  return warehouse::plugin_classes;
}

#define WAREHOUSE_JOIN_(a, b) a##b
#define WAREHOUSE_JOIN(a, b) WAREHOUSE_JOIN_(a, b)
#define WAREHOUSE_ADD_PLUGIN(Class, Interface)                                        \
  namespace {                                                                         \
  warehouse::PluginClass WAREHOUSE_JOIN(plugin_class_, __LINE__){                     \
      #Class, #Interface, &typeid(Interface),                                         \
      []() -> void* { return static_cast<Interface*>(new Class); }, nullptr};         \
  const warehouse::PluginRegistration WAREHOUSE_JOIN(plugin_registration_, __LINE__){ \
      &WAREHOUSE_JOIN(plugin_class_, __LINE__)};                                      \
  }
