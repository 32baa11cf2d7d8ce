// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "core/state/views/model_view.h"

namespace kiva {

/// Makes the plugin of that file name and loads it: the table of the world's options is asked, then
/// a user's library is looked for, by its bare name, in the folders of KIVA_PLUGIN_PATH and in lib/
/// of the workspaces that were sourced. Null, with a warning, if there is none. `model` is empty
/// for a plugin of the world, `sensor` null for one that sits in none. Throws DescriptionError if
/// it is there but can't be loaded, or refuses.
std::shared_ptr<Plugin> loadPlugin(ModelView& world, const std::string& model,
                                   const std::string& filename, const Parameters& parameters,
                                   const SensorDescription* sensor);

}  // namespace kiva
