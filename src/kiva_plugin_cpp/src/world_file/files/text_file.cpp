// SPDX-License-Identifier: Apache-2.0
#include "world_file/files/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

std::string readText(const std::string& path, std::size_t most) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    const char* const what =
        std::filesystem::is_directory(status) ? "is a folder" : "is not a file";
    throw DescriptionError(path + ": can't read this file: " + what);
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw DescriptionError(path + ": can't read this file: " + std::strerror(errno));
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > most) {
    throw DescriptionError(path + ": it has " + std::to_string(size) + " bytes; expected at most " +
                           std::to_string(most));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace kiva
