// SPDX-License-Identifier: Apache-2.0
#include "user_plugins.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <ignition/plugin/Loader.hh>
#include <sstream>

namespace kiva {
namespace {

std::string pluginPath() {
  const char* path = std::getenv("KIVA_PLUGIN_PATH");
  return path ? path : "";
}

/// The library's full path, or the bare name where only the dynamic linker can tell.
std::string locate(const std::string& filename) {
  std::istringstream folders(pluginPath());
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / filename;
    if (!folder.empty() && std::filesystem::exists(file)) return file.string();
  }
  return filename;
}

/// Why the dynamic linker can't open it; empty if it can. Ignition's loader only prints.
std::string linkerError(const std::string& library) {
  void* handle = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!handle) return dlerror();
  dlclose(handle);
  return "";
}

}  // namespace

std::shared_ptr<Plugin> loadUserPlugin(const std::string& filename, const std::string& where) {
  const std::string library = locate(filename);
  const std::string error = linkerError(library);
  if (!error.empty()) {
    throw DescriptionError(where + ": plugin library '" + filename + "' can't be loaded: " + error +
                           " (searched KIVA_PLUGIN_PATH='" + pluginPath() +
                           "' and where the dynamic linker looks)");
  }
  // One loader for all, for as long as the program runs: a library must outlive its objects.
  static ignition::plugin::Loader loader;
  for (const std::string& name : loader.LoadLib(library)) {
    const auto instance = loader.Instantiate(name);
    if (!instance) continue;
    if (auto plugin = instance->QueryInterfaceSharedPtr<Plugin>()) return plugin;
  }
  throw DescriptionError(where + ": library '" + filename +
                         "' holds no class registered with IGNITION_ADD_PLUGIN(…, kiva::Plugin)");
}

}  // namespace kiva
