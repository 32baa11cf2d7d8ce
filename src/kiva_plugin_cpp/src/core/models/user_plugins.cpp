// SPDX-License-Identifier: Apache-2.0
#include "core/models/user_plugins.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "warehouse_layout/plugin_library.h"

namespace kiva {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Returns the folders of KIVA_PLUGIN_PATH, then the library folders of sourced workspaces.
std::vector<std::filesystem::path> libraryFolders() {
  std::vector<std::filesystem::path> out;
  const auto add = [&out](const char* list, const char* below) {
    std::istringstream folders(environment(list));
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (!folder.empty()) out.push_back(std::filesystem::path(folder) / below);
    }
  };
  add("KIVA_PLUGIN_PATH", "");
  add("CMAKE_PREFIX_PATH", "lib");
  return out;
}

/// Returns the library's path; empty, with the reason, if no file is found. An untrusted document
/// may name the library, so it can't choose the folder.
std::string locate(const std::string& filename, std::string* why) {
  if (filename.find('/') != std::string::npos) {
    *why = "'" + filename + "' is a path; a library's name was expected";
    return "";
  }
  std::error_code error;
  for (const std::filesystem::path& folder : libraryFolders()) {
    const std::filesystem::path file = folder / filename;
    if (std::filesystem::is_regular_file(file, error)) return file.string();
  }
  *why = "there is no library '" + filename + "' (searched KIVA_PLUGIN_PATH='" +
         environment("KIVA_PLUGIN_PATH") + "' and lib/ in CMAKE_PREFIX_PATH='" +
         environment("CMAKE_PREFIX_PATH") + "')";
  return "";
}

warehouse::PluginLibrary opened(const std::string& path, const std::string& filename,
                                const std::string& where) {
  try {
    return warehouse::PluginLibrary(path);
  } catch (const std::runtime_error& error) {
    throw DescriptionError(where + ": plugin library '" + filename +
                           "' can't be loaded: " + error.what());
  }
}

/// Returns null, with the reason, if there is no such library.
std::shared_ptr<Plugin> fromLibrary(const std::string& filename, const std::string& where,
                                    std::string* why) {
  const std::string path = locate(filename, why);
  if (path.empty()) return nullptr;
  const warehouse::PluginLibrary library = opened(path, filename, where);
  if (const auto* const plugin_class = library.first<Plugin>())
    return library.make<Plugin>(*plugin_class);
  const std::string others = library.contents();
  throw DescriptionError(where + ": library '" + filename +
                         "' holds no class registered with WAREHOUSE_ADD_PLUGIN(…, kiva::Plugin)" +
                         (others.empty() ? "" : "; it has " + others));
}

/// Returns a warning that a plugin is left out, with the reason. `where` names the model as in its
/// file, `model` as it is called here.
std::string leftOut(const std::string& where, const std::string& model, std::string why) {
  if (why.rfind(where + ": ", 0) == 0) why.erase(0, where.size() + 2);
  const bool is_named = model.empty() || where.find("'" + model + "'") != std::string::npos;
  return where + (is_named ? "" : " of '" + model + "'") + ": the plugin is left out: " + why;
}

/// Throws for a misspelt parameter, unless the plugin takes those of another.
void checkUnread(EventLog& log, const Plugin& plugin, const std::string& filename,
                 const Parameters& parameters) {
  if (plugin.isStrict()) return parameters.rejectUnread();
  std::string list;
  for (const std::string& key : parameters.unread()) list += (list.empty() ? "" : ", ") + key;
  if (list.empty()) return;
  log.warn(filename + list, parameters.where() + ": " + filename + " makes no use of " + list);
}

}  // namespace

std::shared_ptr<Plugin> loadPlugin(TaskView& world, const std::string& model,
                                   const std::string& filename, const Parameters& parameters,
                                   const SensorDescription* sensor) {
  const std::string& where = parameters.where();
  std::string why;
  std::shared_ptr<Plugin> plugin;
  if (world.settings.options.plugins) plugin = world.settings.options.plugins(filename, sensor);
  if (!plugin) plugin = fromLibrary(filename, where, &why);
  if (!plugin) {
    world.log.warn(filename, leftOut(where, model, why));
    return nullptr;
  }
  try {
    plugin->load(*world.plugins.owner, model, parameters);
    checkUnread(world.log, *plugin, filename, parameters);
    return plugin;
  } catch (const std::exception& error) {
    if (plugin->isStrict()) throw;
    world.log.warn(model + filename + error.what(), leftOut(where, model, error.what()));
    return nullptr;
  }
}

}  // namespace kiva
