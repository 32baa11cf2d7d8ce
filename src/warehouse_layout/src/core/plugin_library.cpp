// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/plugin_library.h"

#include <dlfcn.h>

#include <algorithm>

namespace warehouse {
namespace {

std::string withoutNamespace(const std::string& name) {
  const std::size_t end = name.rfind("::");
  return end == std::string::npos ? name : name.substr(end + 2);
}

}  // namespace

PluginLibrary::PluginLibrary(const std::string& path) {
  void* const library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!library) throw std::runtime_error(dlerror());
  using Classes = const PluginClass* (*)();
  const auto classes = reinterpret_cast<Classes>(dlsym(library, kPluginClassesSymbol));
  if (!classes) return;
  for (const PluginClass* plugin = classes(); plugin; plugin = plugin->next)
    classes_.push_back(plugin);
  std::reverse(classes_.begin(), classes_.end());
}

std::string PluginLibrary::contents() const {
  std::string list;
  for (const PluginClass* plugin : classes_) {
    list += std::string(list.empty() ? "" : ", ") + plugin->name + " (" + plugin->interface + ")";
  }
  return list;
}

const PluginClass* PluginLibrary::find(const std::string& name) const {
  for (const PluginClass* plugin : classes_) {
    if (withoutNamespace(plugin->name) == withoutNamespace(name)) return plugin;
  }
  return nullptr;
}

}  // namespace warehouse
