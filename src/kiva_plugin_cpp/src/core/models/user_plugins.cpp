// SPDX-License-Identifier: Apache-2.0
#include "core/models/user_plugins.h"

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

/// Whether the linker found no such file at all; one that lacks another library is broken.
bool isMissing(const std::string& library, const std::string& error) {
  return !std::filesystem::exists(library) && error.rfind(library + ":", 0) == 0;
}

/// Null, with the reason, if there is no such library.
std::shared_ptr<Plugin> fromLibrary(const std::string& filename, const std::string& where,
                                    std::string* why) {
  const std::string library = locate(filename);
  const std::string error = linkerError(library);
  const std::string searched =
      " (searched KIVA_PLUGIN_PATH='" + pluginPath() + "' and where the dynamic linker looks)";
  if (!error.empty() && isMissing(library, error)) {
    *why = "there is no library '" + filename + "'" + searched;
    return nullptr;
  }
  if (!error.empty()) {
    throw DescriptionError(where + ": plugin library '" + filename + "' can't be loaded: " + error +
                           searched);
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

/// What is misspelt is an error, but for plugins that take the parameters of others.
void checkUnread(WorldState& world, const Plugin& plugin, const std::string& filename,
                 const Parameters& parameters) {
  if (plugin.isStrict()) return parameters.rejectUnread();
  std::string list;
  for (const std::string& key : parameters.unread()) list += (list.empty() ? "" : ", ") + key;
  if (list.empty()) return;
  world.warn(filename + list, parameters.where() + ": " + filename + " makes no use of " + list);
}

}  // namespace

std::shared_ptr<Plugin> loadPlugin(WorldState& world, const std::string& model,
                                   const std::string& filename, const Parameters& parameters,
                                   const SensorDescription* sensor) {
  const std::string& where = parameters.where();
  std::string why;
  std::shared_ptr<Plugin> plugin;
  if (world.options.plugins) plugin = world.options.plugins(filename, sensor);
  if (!plugin) plugin = fromLibrary(filename, where, &why);
  if (!plugin) {
    world.warn(filename, where + ": the plugin is left out: " + why);
    return nullptr;
  }
  try {
    plugin->load(*world.owner, model, parameters);
    checkUnread(world, *plugin, filename, parameters);
    return plugin;
  } catch (const std::exception& error) {
    if (plugin->isStrict()) throw;
    world.warn(model + filename + error.what(),
               where + ": the plugin is left out: " + error.what());
    return nullptr;
  }
}

}  // namespace kiva
