// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "kiva_plugin_cpp/plugin.h"

namespace kiva {

/// The plugin class of a user's library, found by its file name in the folders of
/// KIVA_PLUGIN_PATH, else by the dynamic linker. Throws DescriptionError that names what was
/// searched. `where` is put before the message.
std::shared_ptr<Plugin> loadUserPlugin(const std::string& filename, const std::string& where);

}  // namespace kiva
