// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "core/state/views/task_view.h"

namespace kiva {

/// Makes and loads the plugin of that file name. The plugin table of the world's options precedes
/// users' libraries, which are searched for by file name in the folders of KIVA_PLUGIN_PATH, then
/// in lib/ of the sourced workspaces. Returns null, with a warning, if no library has it. `model`
/// is empty for a plugin of the world; `sensor` is null unless the plugin sits in one. Throws
/// DescriptionError if it can't be loaded, or refuses.
std::shared_ptr<Plugin> loadPlugin(TaskView& world, const std::string& model,
                                   const std::string& filename, const Parameters& parameters,
                                   const SensorDescription* sensor);

}  // namespace kiva
