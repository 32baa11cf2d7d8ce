// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/parser.h"

#include "world_file/check/checks.h"
#include "world_file/check/validation.h"
#include "world_file/files/bounded_cache.h"
#include "world_file/files/model_paths.h"
#include "world_file/parsing/conversion.h"
#include "world_file/parsing/expansion.h"
#include "world_file/parsing/include_graph.h"
#include "world_file/parsing/preparation.h"
#include "world_file/urdf/urdf.h"

namespace kiva {
namespace {

XmlElement* sdfOf(XmlDocument* document) {
  XmlElement* const root = document->RootElement();
  if (root && is(*root, "sdf") && root->Attribute("version")) return root;
  const std::string folder =
      !root || is(*root, "sdf") ? "no version" : "<" + std::string(root->Name()) + ">";
  throw SdfError({"expected <sdf version=\"…\"> as the root element, found " + folder, "", "",
                  root ? root->GetLineNum() : 0});
}

void dropIncludes(XmlElement* root) {
  forAll(root, [](XmlElement* element) {
    while (XmlElement* include = element->FirstChildElement("include")) {
      element->DeleteChild(include);
    }
  });
}

/// Returns the fault of a file without its includes; each file is checked once.
std::string faultOfFile(const std::string& text, const std::string& file) {
  static BoundedCache<std::string> cache(1024);
  if (const auto known = cache.find(text)) return *known;
  std::string list;
  try {
    const auto document = parseXml(text);
    XmlElement* const root = sdfOf(document.get());
    dropIncludes(root);
    modernizePoses(document.get());
    convert(root);
    if (const auto fault = firstFault(root)) list = describe(*fault, file);
  } catch (const SdfError& error) {
    list = describe(error.error(), file);
  }
  cache.put(text, std::make_shared<const std::string>(list));
  return list;
}

}  // namespace

bool isUrdf(const std::string& xml) {
  XmlDocument document;
  document.Parse(xml.data(), xml.size());
  return document.RootElement() && is(*document.RootElement(), "robot");
}

SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths) {
  SdfDocument parsed;
  parsed.xml = parseXml(text);
  if (parsed.xml->RootElement() && is(*parsed.xml->RootElement(), "robot")) {
    parsed.xml = sdfFromUrdf(*parsed.xml, &parsed);
  }
  modernizePoses(parsed.xml.get());
  IncludeGraph includes(model_paths, faultOfFile);
  includes.prune(parsed.xml.get(), &parsed.warnings);
  parsed.files = includes.files();
  XmlElement* const root = sdfOf(parsed.xml.get());
  convert(root);
  Faults unknown;
  validate(root, &parsed.warnings, &unknown);
  expandIncludes(model_paths, &parsed);
  parsed.warnings.insert(parsed.warnings.end(), unknown.begin(), unknown.end());
  checkElements(root, &parsed.warnings);
  parsed.xml->setFinal();
  return parsed;
}

}  // namespace kiva
