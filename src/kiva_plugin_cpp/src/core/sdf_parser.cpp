// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_parser.h"

#include <filesystem>
#include <sdf/ParserConfig.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>

#include "core/model_paths.h"
#include "core/sdf_errors.h"
#include "core/sdf_inertia.h"

namespace kiva {
namespace {

/// An empty document. Building the description of SDF takes 30 ms, copying it half of that.
sdf::SDFPtr emptyDocument() {
  static const sdf::SDFPtr kDescription = [] {
    auto description = std::make_shared<sdf::SDF>();
    sdf::init(description);
    return description;
  }();
  auto document = std::make_shared<sdf::SDF>();
  document->Root(kDescription->Root()->Clone());
  return document;
}

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

/// The names of what stands at the top of a text that is no SDF.
[[noreturn]] void failAtRoot() {
  throw SdfError(sdf::Error(sdf::ErrorCode::ELEMENT_MISSING,
                            "expected <sdf version=\"…\"> as the root element"));
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
  // Into an element: given a whole document, libsdformat takes what fails for a URDF and tells the
  // terminal so.
  const bool read = sdf::readString(text, config, document->Root(), errors);
  addCause(&errors, finder, model_paths);
  throwErrors(errors, console.text(), &parsed.warnings);
  if (!read) failAtRoot();
  // Before libsdformat does, whose error has no address.
  checkInertias(document->Root());
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
