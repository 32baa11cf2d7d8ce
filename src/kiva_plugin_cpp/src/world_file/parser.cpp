// SPDX-License-Identifier: Apache-2.0
#include "world_file/parser.h"

#include <algorithm>
#include <filesystem>
#include <sdf/Exception.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/parser.hh>
#include <set>

#include "world_file/bounded_cache.h"
#include "world_file/checks.h"
#include "world_file/errors.h"
#include "world_file/format.h"
#include "world_file/include_graph.h"
#include "world_file/model_paths.h"
#include "world_file/preparation.h"
#include "world_file/repair.h"

namespace kiva {
namespace {

/// The paths come first: libsdformat would look into the current folder before it asks back.
sdf::ParserConfig parserConfig(const ModelPaths& model_paths, std::set<std::string>* missing) {
  sdf::ParserConfig config;
  for (const std::string& folder : model_paths) config.AddURIPath("model://", folder);
  config.SetFindCallback([&model_paths, missing](const std::string& uri) {
    const std::string found = findModel(uri, model_paths);
    if (found.empty()) missing->insert(uri);
    return found;
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
  XmlDocument document;
  document.Parse(text.data(), text.size());
  return document.RootElement() ? document.RootElement()->Name() : "";
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

SdfDocument parseStrictly(const std::string& text, const ModelPaths& model_paths) {
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

/// Reads a text, and turns exceptions of libsdformat into errors.
SdfDocument parseOnce(const std::string& text, const ModelPaths& model_paths) {
  try {
    return parseStrictly(text, model_paths);
  } catch (const SdfError&) {
    throw;
  } catch (const sdf::Exception& fault) {
    failAtFault(fault.GetErrorStr());
  } catch (const std::exception& fault) {
    failAtFault(fault.what());
  }
}

template <typename Parse>
std::optional<sdf::Error> faultOf(Parse parse) {
  try {
    parse();
    return std::nullopt;
  } catch (const SdfError& error) {
    return error.error();
  }
}

void dropIncludes(XmlDocument* document) {
  forAll(document->RootElement(), [](XmlElement* element) {
    while (XmlElement* include = element->FirstChildElement("include")) {
      element->DeleteChild(include);
    }
  });
}

/// What libsdformat has against a file of its own, its includes apart; each is asked once.
std::string faultOfFile(const std::string& text, const std::string& file) {
  static BoundedCache<std::string> cache(1024);
  if (const auto known = cache.find(text)) return *known;
  const auto fault = faultOf([&] {
    const auto document = parseXml(text);
    if (document->RootElement()) dropIncludes(document.get());
    ConsoleCapture console;
    const sdf::ParserConfig config;
    const std::string rest = textOf(*document);
    sdf::Errors errors, ignored;
    const bool read = readInto(emptyDocument(rest), rest, false, config, &errors);
    throwErrors(errors, console.take(), &ignored);
    if (!read) failAtRoot(document->RootElement() ? document->RootElement()->Name() : "");
  });
  const std::string told = fault ? describe(*fault, file) : "";
  cache.put(text, std::make_shared<const std::string>(told));
  return told;
}

/// Returns how often a text may be read again without one of its faulty parts.
std::size_t mostRepairs(const std::string& text) {
  constexpr std::size_t kMostRead = 50'000'000;  // [byte]
  return std::clamp<std::size_t>(kMostRead / (text.size() + 1), 10, 300);
}

}  // namespace

bool isUrdf(const std::string& xml) { return rootOf(xml) == "robot"; }

SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths) {
  const auto document = parseXml(text);
  if (document->RootElement() && document->RootElement()->Name() == std::string("robot")) {
    return parseOnce(text, model_paths);
  }
  sdf::Errors warnings;
  modernizePoses(document.get());
  IncludeGraph includes(model_paths, faultOfFile);
  includes.prune(document.get(), &warnings);
  const FaultOf fault_of = [&](const XmlDocument& tried) {
    return faultOf([&] { parseOnce(textOf(tried), model_paths); });
  };
  for (std::size_t left = mostRepairs(text);; --left) {
    try {
      SdfDocument parsed = parseOnce(textOf(*document), model_paths);
      parsed.warnings.insert(parsed.warnings.begin(), warnings.begin(), warnings.end());
      parsed.files.insert(includes.files().begin(), includes.files().end());
      return parsed;
    } catch (const SdfError& error) {
      if (left == 0 || !leaveOut(error.error(), fault_of, document.get(), &warnings)) throw;
    }
  }
}

}  // namespace kiva
