// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/include_graph.h"

#include <algorithm>
#include <filesystem>

#include "world_file/files/errors.h"
#include "world_file/files/model_paths.h"
#include "world_file/files/text_file.h"
#include "world_file/sdf/stand_in.h"

namespace kiva {
namespace {

constexpr int kMostIncludes = 1000;      // within models
constexpr std::size_t kMostNested = 30;  // includes in includes

bool isInclude(const XmlElement& element) { return element.Name() == std::string("include"); }

std::string blankField(const XmlElement& include) {
  for (const char* field : {"uri", "name", "static", "placement_frame"}) {
    const XmlElement* const child = include.FirstChildElement(field);
    const bool is_missing = !child && field == std::string("uri");
    if (is_missing || (child && contentOf(child).empty())) return field;
  }
  return "";
}

/// Returns whether the include's file is older than SDF 1.7, with a pose in the old way.
bool hasOldPose(const XmlElement& include) {
  const XmlElement* const pose = include.FirstChildElement("pose");
  return pose && pose->Attribute("frame");
}

/// Returns whether a stand-in is possible: it can't move, so it must be in a world or a static
/// model.
bool mayStandIn(const XmlElement& around) {
  if (around.Name() == std::string("world")) return true;
  if (around.Name() != std::string("model")) return false;
  const std::string is_static = contentOf(around.FirstChildElement("static"));
  if (is_static == "true" || is_static == "1") return true;
  const XmlElement* const include = around.FirstChildElement("include");
  return !around.FirstChildElement("link") && !around.FirstChildElement("model") &&
         !include->NextSiblingElement("include");
}

void setChild(XmlElement* element, const char* name, const std::string& text) {
  XmlElement* child = element->FirstChildElement(name);
  if (!child) child = element->InsertNewChildElement(name);
  child->SetText(text.c_str());
}

/// Replaces the model of an include by a stand-in with the same place and name.
void nameStandIn(XmlElement* include) {
  const std::string uri = contentOf(include->FirstChildElement("uri"));
  if (!include->FirstChildElement("name")) setChild(include, "name", nameIn(uri));
  setChild(include, "uri", kUnknownObstacle);
  XmlElement* next = nullptr;
  for (XmlElement* child = include->FirstChildElement(); child; child = next) {
    next = child->NextSiblingElement();
    const std::string kind = child->Name();
    if (kind != "uri" && kind != "name" && kind != "pose") include->DeleteChild(child);
  }
}

}  // namespace

IncludeGraph::IncludeGraph(const ModelPaths& model_paths, FaultOf fault_of)
    : model_paths_(model_paths), fault_of_(std::move(fault_of)) {}

void IncludeGraph::prune(XmlDocument* document, Faults* warnings) {
  XmlElement* const root = document->RootElement();
  if (!root) return;
  forAll(root, [&](XmlElement* element) {
    XmlElement* next = nullptr;
    for (XmlElement* include = element->FirstChildElement("include"); include; include = next) {
      next = include->NextSiblingElement("include");
      const IncludeFault fault = faultOfInclude(*include);
      if (fault.what.empty()) continue;
      const XmlElement* const uri = include->FirstChildElement("uri");
      const bool stands_in = fault.is_of_model && mayStandIn(*element) && hasStandIn();
      warnings->push_back(noteAt(uri ? *uri : *include, "this include is left out: " + fault.what +
                                                            (stands_in ? kStandsIn : "")));
      if (stands_in) {
        nameStandIn(include);
      } else {
        element->DeleteChild(include);
      }
    }
  });
}

bool IncludeGraph::hasStandIn() const { return !findModel(kUnknownObstacle, model_paths_).empty(); }

IncludeGraph::IncludeFault IncludeGraph::faultOfInclude(const XmlElement& include) {
  const std::string blank = blankField(include);
  if (!blank.empty()) return {"expected a text in <" + blank + ">"};
  const std::string uri = contentOf(include.FirstChildElement("uri"));
  const Cost cost = follow(uri);
  if (!cost.fault.empty()) return {cost.fault, true};
  if (includes_ + cost.includes > kMostIncludes) {
    return {"with it there would be more than " + std::to_string(kMostIncludes) +
            " includes in models"};
  }
  if (bytes_ + cost.bytes > kMostBytes) {
    return {"with it there would be more than " + std::to_string(kMostBytes) + " bytes to read"};
  }
  includes_ += cost.includes;
  bytes_ += cost.bytes;
  return {};
}

IncludeGraph::Cost IncludeGraph::follow(const std::string& uri) {
  Cost cost;
  const std::string place = findModel(uri, model_paths_);
  if (place.empty()) {
    cost.fault = modelNotFound(uri, model_paths_);
    addCandidates(uri, model_paths_, &files_);
    return cost;
  }
  std::string file;
  try {
    file = std::filesystem::weakly_canonical(modelFile(place)).string();
    files_.insert({file, (std::filesystem::path(file).parent_path() / "model.config").string()});
    if (open_.count(file)) {
      cost.fault = "the model '" + uri + "' includes itself, perhaps by way of others";
      return cost;
    }
    const auto known = known_.find(file);
    if (known != known_.end()) return known->second;
    if (open_.size() > kMostNested) {
      cost.fault = "its includes nest deeper than " + std::to_string(kMostNested);
      return cost;
    }
    open_.insert(file);
    cost = read(file);
    open_.erase(file);
  } catch (const SdfError& error) {
    open_.erase(file);
    cost.fault = describe(error.error(), file.empty() ? place + "/model.config" : file);
  } catch (const std::exception& error) {
    open_.erase(file);
    cost.fault = error.what();
  }
  if (!file.empty()) known_[file] = cost;
  return cost;
}

IncludeGraph::Cost IncludeGraph::read(const std::string& file) {
  const std::string text = readText(file, kMostBytes);
  const auto document = parseXml(text);
  Cost cost;
  cost.includes = 1;
  cost.bytes = static_cast<double>(text.size());
  if (!document->RootElement()) return cost;
  const bool is_new = document->RootElement()->DoubleAttribute("version", 0) > 1.65;
  forAll(document->RootElement(), [&](XmlElement* element) {
    if (!isInclude(*element) || !cost.fault.empty()) return;
    const Cost inner = follow(contentOf(element->FirstChildElement("uri")));
    if (is_new && hasOldPose(*element)) {
      cost.fault = describe(noteAt(*element, "poses of includes have no 'frame'"), file);
    }
    // Missing includes of the inner file cost only themselves.
    const bool is_missing = inner.includes == 0 && inner.fault.rfind("found no", 0) == 0;
    if (!is_missing && !inner.fault.empty()) cost.fault = inner.fault;
    cost.includes = std::min(cost.includes + inner.includes, 1e9);
    cost.bytes = std::min(cost.bytes + inner.bytes, 1e15);
  });
  if (cost.fault.empty()) cost.fault = fault_of_(text, file);
  return cost;
}

}  // namespace kiva
