// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_parser.h"

#include <filesystem>
#include <sdf/ParserConfig.hh>
#include <sdf/parser.hh>

#include "core/model_paths.h"
#include "core/sdf_checks.h"
#include "core/sdf_errors.h"
#include "core/sdf_format.h"
#include "core/tag_scanner.h"

namespace kiva {
namespace {

/// Follows what libsdformat includes.
class ModelFinder {
 public:
  explicit ModelFinder(const ModelPaths& paths) : paths_(paths) {}

  std::string operator()(const std::string& uri) {
    const std::string path = findModel(uri, paths_);
    if (path.empty()) {
      if (missing.empty()) missing = uri;
      return "";
    }
    if (std::filesystem::is_directory(path)) {
      files.push_back(path + "/model.config");
      files.push_back(sdf::getModelFilePath(path));
    } else {
      files.push_back(path);
    }
    return path;
  }

  std::vector<std::string> files;
  std::string missing;  ///< The first that is nowhere.

 private:
  const ModelPaths& paths_;
};

/// Everything that libsdformat could say is an error here; `throwErrors` finds the harmless.
sdf::ParserConfig parserConfig(ModelFinder* finder) {
  sdf::ParserConfig config;
  config.SetFindCallback([finder](const std::string& uri) { return (*finder)(uri); });
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::ERR);
  return config;
}

std::string rootOf(const std::string& text) {
  TagScanner scanner(text);
  return scanner.next() ? std::string(scanner.name) : "";
}

[[noreturn]] void failAtRoot(const std::string& root) {
  const std::string found = root == "sdf" ? "no version" : "<" + root + ">";
  throw SdfError(sdf::Error(sdf::ErrorCode::ELEMENT_MISSING,
                            "expected <sdf version=\"…\"> as the root element, found " + found));
}

/// SDF goes into an element: given a whole document, libsdformat takes SDF that fails for a URDF
/// and tells the terminal so.
bool readInto(const sdf::SDFPtr& document, const std::string& text, bool is_urdf,
              const sdf::ParserConfig& config, sdf::Errors* errors) {
  return is_urdf ? sdf::readString(text, config, document, *errors)
                 : sdf::readString(text, config, document->Root(), *errors);
}

void addCause(sdf::Errors* errors, const ModelFinder& finder, const ModelPaths& paths) {
  if (finder.missing.empty() || errors->empty()) return;
  sdf::Error error(sdf::ErrorCode::URI_LOOKUP, modelNotFound(finder.missing, paths));
  if (errors->front().LineNumber()) error.SetLineNumber(*errors->front().LineNumber());
  if (errors->front().FilePath()) error.SetFilePath(*errors->front().FilePath());
  if (errors->front().XmlPath()) error.SetXmlPath(*errors->front().XmlPath());
  errors->insert(errors->begin(), error);
}

}  // namespace

SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths) {
  const ConsoleCapture console;
  ModelFinder finder(model_paths);
  const sdf::ParserConfig config = parserConfig(&finder);
  const sdf::SDFPtr document = emptyDocument();
  sdf::Errors errors;
  SdfDocument parsed;
  const std::string root = rootOf(text);
  const bool read = readInto(document, text, root == "robot", config, &errors);
  addCause(&errors, finder, model_paths);
  throwErrors(errors, console.text(), &parsed.warnings);
  if (!read) failAtRoot(root);
  checkElements(document->Root());
  parsed.root = std::make_unique<sdf::Root>();
  throwErrors(parsed.root->Load(document, config), "", &parsed.warnings);
  parsed.files = std::move(finder.files);
  return parsed;
}

std::string modelFile(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) return folder;
  const ConsoleCapture console;
  const std::string file = sdf::getModelFilePath(folder);
  sdf::Errors warnings;
  throwErrors({}, console.text(), &warnings);
  return file;
}

}  // namespace kiva
