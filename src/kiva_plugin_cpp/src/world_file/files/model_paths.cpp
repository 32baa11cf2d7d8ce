// SPDX-License-Identifier: Apache-2.0
#include "world_file/files/model_paths.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include "world_file/files/text_file.h"
#include "world_file/files/xml.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

constexpr int kFoldersAbove = 2;  // above the folder of a file

/// Returns `uri` without that scheme; empty if it has another one.
std::string after(const char* scheme, const std::string& uri) {
  return startsWith(uri, scheme) ? uri.substr(std::string(scheme).size()) : "";
}

bool isOfModels(const std::string& uri) {
  return startsWith(uri, "model://") || startsWith(uri, "package://");
}

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Returns the path in a uri, absolute or to be searched for; empty if it names no file on this
/// disk.
std::string pathIn(const std::string& uri) {
  for (const char* scheme : {"model://", "package://", "file://"}) {
    if (startsWith(uri, scheme)) return after(scheme, uri);
  }
  return uri.find("://") == std::string::npos ? uri : "";
}

void add(const fs::path& folder, ModelPaths* folders) {
  std::string path = (folder / "").lexically_normal().string();
  if (path.size() > 1) path.pop_back();  // its last slash
  const bool is_known = std::find(folders->begin(), folders->end(), path) != folders->end();
  std::error_code ignored;
  if (!is_known && fs::is_directory(path, ignored)) folders->push_back(path);
}

void addWithThoseAbove(const fs::path& folder, ModelPaths* folders) {
  fs::path above = fs::absolute(folder / "").lexically_normal().parent_path();
  for (int i = 0; i <= kFoldersAbove; ++i, above = above.parent_path()) add(above, folders);
}

/// Where what a uri names is looked up, if it is not absolute. Gazebo has `file://models/name` in
/// folders that hold a folder of models, which are those above our model paths. `folder`: of the
/// document, empty if it is not known.
ModelPaths foldersFor(const std::string& uri, const fs::path& folder, const ModelPaths& paths) {
  if (isOfModels(uri)) return paths;
  ModelPaths folders;
  if (!folder.empty()) addWithThoseAbove(folder, &folders);
  for (const std::string& path : paths) {
    add(path, &folders);
    add(fs::path(path).parent_path(), &folders);
  }
  return folders;
}

/// Returns the folder, or the current one for a file without a folder.
fs::path folderOr(const std::string& folder) { return folder.empty() ? "." : folder; }

/// Returns the file at `path`, or one whose ending differs in case; empty if no such file exists.
std::string existing(const fs::path& path) {
  if (isFile(path)) return path.lexically_normal().string();
  for (const bool upper : {false, true}) {
    std::string ending = path.extension().string();
    for (char& letter : ending) {
      letter = static_cast<char>(upper ? std::toupper(letter) : std::tolower(letter));
    }
    const fs::path other = fs::path(path).replace_extension(ending);
    if (isFile(other)) return other.lexically_normal().string();
  }
  return "";
}

std::string listOf(const ModelPaths& folders) {
  std::string list;
  for (const std::string& folder : folders) list += (list.empty() ? "" : ", ") + folder;
  return list;
}

bool isModel(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path / "model.config", ignored) || fs::is_regular_file(path, ignored);
}

/// Returns the newest of the files that a model.config names for versions of SDF. Throws SdfError.
std::string newestFile(const std::string& config) {
  static const std::regex kVersion("[0-9]{0,4}(\\.[0-9]{1,4}){0,2}");
  constexpr double kNewest = 1.91;  // for 1.10 and 1.11, which as numbers are less than 1.9
  const auto document = parseXml(readText(config, kMostBytes));
  const XmlElement* const model = document->FirstChildElement("model");
  if (!model) throw SdfError({"expected a <model>", "", "", 0});
  std::string newest;
  double best = 0;
  for (const XmlElement* sdf = model->FirstChildElement("sdf"); sdf;
       sdf = sdf->NextSiblingElement("sdf")) {
    const std::string version = attributeOf(*sdf, "version");
    if (!std::regex_match(version, kVersion)) {
      throw SdfError(noteAt(*sdf, "version '" + version + "' is not a number"));
    }
    const double number = std::atof(version.c_str());
    if (contentOf(sdf).empty() || number <= best || number > kNewest) continue;
    best = number;
    newest = contentOf(sdf);
  }
  if (newest.empty()) {
    throw SdfError(noteAt(*model, "expected a <name>, and an <sdf> with a version, in <model>"));
  }
  return newest;
}

}  // namespace

std::string findModel(const std::string& uri, const ModelPaths& paths) {
  const std::string path = pathIn(uri);
  if (path.empty()) return "";
  if (fs::path(path).is_absolute()) return isModel(path) ? path : "";
  for (const std::string& folder : foldersFor(uri, "", paths)) {
    const fs::path candidate = fs::path(folder) / path;
    if (isModel(candidate)) return candidate.string();
  }
  return "";
}

std::string findFile(const std::string& uri, const std::string& folder, const ModelPaths& paths) {
  const std::string path = pathIn(uri);
  if (path.empty()) return "";
  if (fs::path(path).is_absolute()) return existing(path);
  for (const std::string& around : foldersFor(uri, folderOr(folder), paths)) {
    const std::string file = existing(fs::path(around) / path);
    if (!file.empty()) return file;
  }
  return "";
}

std::string fileNotFound(const std::string& uri, const std::string& folder,
                         const ModelPaths& paths) {
  const std::string path = pathIn(uri);
  if (path.empty() || fs::path(path).is_absolute()) return "there is no file '" + uri + "'";
  const std::string folders = listOf(foldersFor(uri, folderOr(folder), paths));
  return "there is no file '" + uri + "' in " +
         (folders.empty() ? "the model paths, which are empty" : folders);
}

std::string modelNotFound(const std::string& uri, const ModelPaths& paths) {
  const std::string folders = listOf(foldersFor(uri, "", paths));
  return "found no model for '" + uri +
         "'; expected a folder of that name with a model.config in " +
         (folders.empty() ? "the model paths, which are empty" : folders);
}

std::string leftOut(const std::string& uri, const ModelPaths& paths) {
  return "this include is left out: " + modelNotFound(uri, paths);
}

std::string modelFile(const std::string& folder) {
  if (!fs::is_directory(folder)) return folder;
  const fs::path path(folder);
  return (path / newestFile((path / "model.config").string())).string();
}

void addCandidates(const std::string& uri, const ModelPaths& paths, std::set<std::string>* files) {
  const std::string path = pathIn(uri);
  if (path.empty()) return;
  for (const std::string& folder : foldersFor(uri, "", paths)) {
    files->insert((fs::path(folder) / path / "model.config").string());
  }
}

ModelPaths environmentModelPaths() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::string(value ? value : "");
  };
  ModelPaths paths = splitPaths(variable("GAZEBO_MODEL_PATH"));
  for (std::string& path : exportedModelPaths(variable("ROS_PACKAGE_PATH"))) {
    paths.push_back(std::move(path));
  }
  for (const std::string& path : splitPaths(variable("GAZEBO_RESOURCE_PATH"))) {
    add(path, &paths);
    add(fs::path(path) / "models", &paths);
  }
  return paths;
}

ModelPaths modelPathsAround(const std::string& world_file) {
  ModelPaths paths;
  ModelPaths folders;
  addWithThoseAbove(folderOr(fs::path(world_file).parent_path().string()), &folders);
  for (const std::string& folder : folders) {
    add(folder, &paths);
    add(fs::path(folder) / "models", &paths);
  }
  return paths;
}

}  // namespace kiva
