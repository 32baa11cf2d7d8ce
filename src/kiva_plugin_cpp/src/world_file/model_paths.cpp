// SPDX-License-Identifier: Apache-2.0
#include "world_file/model_paths.h"

#include <filesystem>
#include <regex>
#include <sdf/parser.hh>

#include "world_file/errors.h"
#include "world_file/files.h"
#include "world_file/xml.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

constexpr char kScheme[] = "model://";
constexpr std::size_t kSchemeLength = sizeof(kScheme) - 1;

bool isModelUri(const std::string& uri) { return uri.compare(0, kSchemeLength, kScheme) == 0; }

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// `file:///path` and `/path`; empty for others.
std::string absolutePath(const std::string& uri) {
  const std::string path = startsWith(uri, "file://") ? uri.substr(7) : uri;
  return !path.empty() && path[0] == '/' ? path : "";
}

bool isModel(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path / "model.config", ignored) || fs::is_regular_file(path, ignored);
}

/// libsdformat 12 ends the process where it wants to tell the name of a model that has none, and
/// throws a bare "stoi" at versions that are no numbers. Throws SdfError before it comes to that.
void checkConfig(const std::string& file) {
  static const std::regex kVersion("[0-9]{0,4}(\\.[0-9]{1,4}){0,2}");
  const auto document = parseXml(readText(file, kMostBytes));
  const XmlElement* const model = document->FirstChildElement("model");
  if (!model) return;
  const XmlElement* sdf = model->FirstChildElement("sdf");
  bool has_all = sdf != nullptr;
  for (; sdf; sdf = sdf->NextSiblingElement("sdf")) {
    const std::string version = attributeOf(*sdf, "version");
    if (!std::regex_match(version, kVersion)) {
      throw SdfError(noteAt(*sdf, "version '" + version + "' is no number"));
    }
    has_all = has_all && !contentOf(sdf).empty() && sdf->Attribute("version") &&
              std::atof(version.c_str()) <= std::atof(SDF_VERSION);
  }
  if (!has_all && !model->FirstChildElement("name")) {
    throw SdfError(noteAt(*model, "expected a <name>, and an <sdf> with a version, in <model>"));
  }
}

}  // namespace

std::string findModel(const std::string& uri, const ModelPaths& paths) {
  const std::string absolute = absolutePath(uri);
  if (!absolute.empty()) return isModel(absolute) ? absolute : "";
  if (!isModelUri(uri) || uri.size() == kSchemeLength) return "";
  for (const std::string& folder : paths) {
    const fs::path path = fs::path(folder) / uri.substr(kSchemeLength);
    if (isModel(path)) return path.string();
  }
  return "";
}

std::string findFile(const std::string& uri, const std::string& folder, const ModelPaths& paths) {
  std::string path = uri;
  for (const std::string scheme : {"model://", "package://", "file://"}) {
    if (startsWith(uri, scheme)) path = uri.substr(scheme.size());
  }
  const bool is_in_models = path != uri && !startsWith(uri, "file://");
  if (path.empty()) return "";
  // `/` with an absolute path yields that path.
  const fs::path beside = fs::path(folder) / path;
  if (!is_in_models && isFile(beside)) return beside.lexically_normal().string();
  for (const std::string& models : paths) {
    const fs::path found = fs::path(models) / path;
    if (isFile(found)) return found.lexically_normal().string();
  }
  return "";
}

std::string modelNotFound(const std::string& uri, const ModelPaths& paths) {
  std::string folders;
  for (const std::string& folder : paths) folders += (folders.empty() ? "" : ", ") + folder;
  return "found no model for '" + uri +
         "'; expected a folder of that name with a model.config in " +
         (folders.empty() ? "the model paths, which are empty" : folders);
}

std::string leftOut(const std::string& uri, const ModelPaths& paths) {
  return "this include is left out: " + modelNotFound(uri, paths);
}

std::string modelFile(const std::string& folder) {
  if (!fs::is_directory(folder)) return folder;
  checkConfig((fs::path(folder) / "model.config").string());
  ConsoleCapture console;
  const std::string file = sdf::getModelFilePath(folder);
  sdf::Errors warnings;
  throwErrors({}, console.take(), &warnings);
  return file;
}

void addCandidates(const std::string& uri, const ModelPaths& paths, std::set<std::string>* files) {
  if (!isModelUri(uri)) return;
  for (const std::string& folder : paths) {
    files->insert((fs::path(folder) / uri.substr(kSchemeLength) / "model.config").string());
  }
}

}  // namespace kiva
