// SPDX-License-Identifier: Apache-2.0
#include "packages.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace kiva_ros {
namespace {

namespace fs = std::filesystem;

constexpr int kDepth = 2;
const std::string kScheme = "package://";

bool isPackage(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "package.xml", ignored);
}

fs::path findBelow(const fs::path& folder, const std::string& name, int depth) {
  if (isPackage(folder / name)) return folder / name;
  if (depth == 0) return {};
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!entry.is_directory(ignored) || isPackage(entry.path())) continue;
    const fs::path found = findBelow(entry.path(), name, depth - 1);
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream folders(list);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) out.push_back(folder);
  }
  return out;
}

std::string findPackage(const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos || name[0] == '.') return "";
  for (const fs::path root : split(environment("ROS_PACKAGE_PATH"))) {
    if (root.filename() == name && isPackage(root)) return root.string();
    const fs::path found = findBelow(root, name, kDepth);
    if (!found.empty()) return found.string();
  }
  return "";
}

std::string resolvePackages(const std::string& text) {
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = text.find(kScheme); at != std::string::npos;
       at = text.find(kScheme, at + 1)) {
    const std::size_t begin = at + kScheme.size();
    const std::size_t end = text.find_first_of("/\"'< ", begin);
    if (end == std::string::npos || text[end] != '/') continue;
    const std::string path = findPackage(text.substr(begin, end - begin));
    if (path.empty()) continue;
    out += text.substr(done, at - done) + path;
    done = end;
  }
  return out + text.substr(done);
}

}  // namespace kiva_ros
