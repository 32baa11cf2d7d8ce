// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/errors.h"
#include "world_file/files/model_paths.h"
#include "world_file/files/text_file.h"
#include "world_file/files/xml.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 4;  // levels of folders
constexpr std::size_t kMostPackageBytes = 100'000;
constexpr char kPrefix[] = "${prefix}";

bool has(const fs::path& folder, const char* file) {
  std::error_code ignored;
  return fs::exists(folder / file, ignored);
}

/// Returns the folders in a folder, sorted, so that their order does not depend on the disk.
std::vector<fs::path> foldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const bool is_hidden = entry.path().filename().string()[0] == '.';
    if (!is_hidden && entry.is_directory(ignored)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void addExports(const fs::path& package, ModelPaths* paths) {
  XmlDocument document;
  try {
    const std::string text = readText((package / "package.xml").string(), kMostPackageBytes);
    if (document.Parse(text.c_str()) != tinyxml2::XML_SUCCESS) return;
  } catch (const DescriptionError&) {
    return;  // Another tool reports it.
  }
  const XmlElement* const root = document.RootElement();
  const XmlElement* const exports = root ? root->FirstChildElement("export") : nullptr;
  if (!exports) return;
  for (const XmlElement* gazebo = exports->FirstChildElement("gazebo_ros"); gazebo;
       gazebo = gazebo->NextSiblingElement("gazebo_ros")) {
    for (std::string path : splitPaths(attributeOf(*gazebo, "gazebo_model_path"))) {
      const std::size_t at = path.find(kPrefix);
      if (at != std::string::npos) path.replace(at, sizeof(kPrefix) - 1, package.string());
      paths->push_back(fs::path(path).lexically_normal().string());
    }
  }
}

/// Searches for packages as rospack does: packages hold no packages.
void crawl(const fs::path& folder, int depth, ModelPaths* paths) {
  if (has(folder, "CATKIN_IGNORE") || has(folder, "ROS_IGNORE")) return;
  if (has(folder, "package.xml")) return addExports(folder, paths);
  if (depth == kDeepest || has(folder, "rospack_nosubdirs")) return;
  for (const fs::path& inside : foldersIn(folder)) crawl(inside, depth + 1, paths);
}

}  // namespace

ModelPaths splitPaths(const std::string& list) {
  ModelPaths out;
  std::istringstream paths(list);
  for (std::string path; std::getline(paths, path, ':');) {
    if (!path.empty()) out.push_back(path);
  }
  return out;
}

ModelPaths exportedModelPaths(const std::string& ros_package_path) {
  ModelPaths paths;
  for (const std::string& root : splitPaths(ros_package_path)) crawl(root, 0, &paths);
  return paths;
}

}  // namespace kiva
