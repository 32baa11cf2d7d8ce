// SPDX-License-Identifier: Apache-2.0
#include "world_file/parser.h"

#include <algorithm>
#include <filesystem>
#include <sdf/Exception.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/parser.hh>
#include <set>

#include "world_file/checks.h"
#include "world_file/cycles.h"
#include "world_file/errors.h"
#include "world_file/format.h"
#include "world_file/includes.h"
#include "world_file/model_paths.h"
#include "world_file/tag_scanner.h"

namespace kiva {
namespace {

/// The paths come first: libsdformat would look into the current folder before it asks back. What
/// is asked for is in none of them.
sdf::ParserConfig parserConfig(const ModelPaths& model_paths, std::set<std::string>* missing) {
  sdf::ParserConfig config;
  for (const std::string& folder : model_paths) config.AddURIPath("model://", folder);
  config.SetFindCallback([missing](const std::string& uri) {
    missing->insert(uri);
    return "";
  });
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::WARN);
  return config;
}

/// libsdformat 12 forgets the configuration of a call where an included model includes another, and
/// takes the process's own; that is ours for the time of the call.
class GlobalConfig {
 public:
  explicit GlobalConfig(const sdf::ParserConfig& config)
      : before_(sdf::ParserConfig::GlobalConfig()) {
    sdf::ParserConfig::GlobalConfig() = config;
  }
  ~GlobalConfig() { sdf::ParserConfig::GlobalConfig() = before_; }
  GlobalConfig(const GlobalConfig&) = delete;
  GlobalConfig& operator=(const GlobalConfig&) = delete;

 private:
  const sdf::ParserConfig before_;
};

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

/// libsdformat goes on without an include whose model is not there. The errors it has of that
/// become warnings; it has none if it is a model in a model in a model.
void excuseMissing(const std::set<std::string>& missing, const ModelPaths& paths,
                   sdf::Errors* errors, sdf::Errors* warnings) {
  for (const std::string& uri : missing) {
    const auto is_about_it = [&](const sdf::Error& error) {
      return error.Code() == sdf::ErrorCode::URI_LOOKUP &&
             error.Message().find("[" + uri + "]") != std::string::npos;
    };
    const std::string message = leftOut(uri, paths);
    const bool has_error = std::any_of(errors->begin(), errors->end(), is_about_it);
    if (!has_error) warnings->push_back(sdf::Error(sdf::ErrorCode::URI_LOOKUP, message));
    for (const sdf::Error& error : *errors) {
      if (is_about_it(error)) warnings->push_back(reworded(error, message));
    }
    errors->erase(std::remove_if(errors->begin(), errors->end(), is_about_it), errors->end());
  }
}

/// The files of `element` and of all below it, each with the model.config beside it.
void collectFiles(const sdf::ElementPtr& element, std::set<std::string>* files) {
  const std::string& file = element->FilePath();
  if (!file.empty() && file[0] != '<' && files->insert(file).second) {
    files->insert((std::filesystem::path(file).parent_path() / "model.config").string());
  }
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    collectFiles(child, files);
  }
}

SdfDocument parse(const std::string& text, const ModelPaths& model_paths) {
  ConsoleCapture console;
  std::set<std::string> missing;
  const sdf::ParserConfig config = parserConfig(model_paths, &missing);
  const GlobalConfig global(config);
  const std::string root = rootOf(text);
  const sdf::SDFPtr document = emptyDocument(text);
  sdf::Errors errors;
  SdfDocument parsed;
  const bool read = readInto(document, text, root == "robot", config, &errors);
  excuseMissing(missing, model_paths, &errors, &parsed.warnings);
  throwErrors(errors, console.take(), &parsed.warnings);
  if (!read) failAtRoot(root);
  checkElements(document->Root(), &parsed.warnings);
  parsed.root = std::make_unique<sdf::Root>();
  const sdf::Errors load_errors = parsed.root->Load(document, config);
  throwErrors(load_errors, console.take(), &parsed.warnings);
  collectFiles(document->Root(), &parsed.files);
  for (const std::string& uri : missing) addCandidates(uri, model_paths, &parsed.files);
  return parsed;
}

[[noreturn]] void failAtFault(const std::string& what) {
  throw SdfError(
      sdf::Error(sdf::ErrorCode::STRING_READ, "libsdformat gave up on this text: " + what));
}

}  // namespace

bool isUrdf(const std::string& xml) { return rootOf(xml) == "robot"; }

SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths) {
  checkIncludes(text);
  checkCycles(text, model_paths);
  try {
    return parse(text, model_paths);
  } catch (const SdfError&) {
    throw;
  } catch (const sdf::Exception& fault) {
    failAtFault(fault.GetErrorStr());
  } catch (const std::exception& fault) {
    failAtFault(fault.what());
  }
}

std::string modelFile(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) return folder;
  ConsoleCapture console;
  const std::string file = sdf::getModelFilePath(folder);
  sdf::Errors warnings;
  throwErrors({}, console.take(), &warnings);
  return file;
}

}  // namespace kiva
