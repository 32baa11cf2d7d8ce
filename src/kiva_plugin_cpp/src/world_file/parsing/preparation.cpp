// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/preparation.h"

#include <algorithm>
#include <set>

#include "world_file/files/errors.h"
#include "world_file/files/model_paths.h"
#include "world_file/parsing/actors.h"
#include "world_file/parsing/population.h"

namespace kiva {
namespace {

constexpr char kPerson[] = "model://person";

/// Returns whether a name has no special meaning in SDF.
bool isPlainName(const std::string& name) {
  return !name.empty() && name != "world" && name.find("::") == std::string::npos &&
         name.compare(0, 2, "__") != 0;
}

std::optional<bool> parseFlag(const std::string& text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

/// Returns whether SDF reserves a name, even for a world.
bool isReserved(const std::string& name) {
  const bool is_internal = name.size() >= 4 && name.compare(0, 2, "__") == 0 &&
                           name.compare(name.size() - 2, 2, "__") == 0;
  return name == "world" || is_internal;
}

/// Reads a child of an include. Returns false if the child has more than can be taken out.
bool setField(const std::string& field, const std::string& text, Include* include) {
  if (field == "uri") {
    include->uri = text;
    return !text.empty();
  }
  if (field == "name") {
    include->name = text;
    return isPlainName(text);
  }
  if (field == "pose") return (include->pose = parsePose(text)).has_value();
  if (field == "static") return (include->is_static = parseFlag(text)).has_value();
  return false;
}

std::optional<Include> readInclude(const XmlElement& element) {
  Include include;
  std::set<std::string> fields;
  if (element.FirstAttribute()) return std::nullopt;
  for (const XmlElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const bool is_leaf = !child->FirstAttribute() && !child->FirstChildElement();
    if (!is_leaf || !fields.insert(child->Name()).second) return std::nullopt;
    if (!setField(child->Name(), contentOf(child), &include)) return std::nullopt;
  }
  if (include.uri.empty()) return std::nullopt;
  return include;
}

/// Returns whether a part of the world is placed relative to another, perhaps to an include. Names
/// deeper down refer to parts of the model around them.
bool refersToOthers(const XmlElement& element, int depth) {
  constexpr int kPoseOfModel = 4;  // sdf, world, model, pose.
  if (element.Attribute("relative_to") || element.Attribute("attached_to")) return true;
  if (depth == kPoseOfModel) return false;
  for (const XmlElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    if (refersToOthers(*child, depth + 1)) return true;
  }
  return false;
}

/// The text that models have in common if they differ only in name and pose. Nothing for a model
/// whose pose is not a plain one.
struct ModelText {
  std::string common;
  std::string name;
  Pose pose;
};

std::optional<ModelText> readModelText(const XmlElement& model) {
  const std::string name = attributeOf(model, "name");
  if (!isPlainName(name)) return std::nullopt;
  ModelText out{"", name, Pose::Zero};
  const XmlElement* const pose = model.FirstChildElement("pose");
  if (pose) {
    const auto numbers = parsePose(contentOf(pose));
    if (!numbers || pose->FirstAttribute()) return std::nullopt;
    out.pose = *numbers;
  }
  for (const char* attribute : {"canonical_link", "placement_frame"}) {
    out.common += attributeOf(model, attribute) + '\n';
  }
  const std::string text = textOf(model, pose);
  out.common += text.substr(text.find('>') + 1);
  return out;
}

void setContent(XmlElement* parent, const char* name, const std::string& text) {
  XmlElement* child = parent->FirstChildElement(name);
  if (!child) child = parent->InsertNewChildElement(name);
  child->DeleteChildren();
  child->SetText(text.c_str());
}

/// Extracts the contents of a PreparedText from a document.
class Preparation {
 public:
  explicit Preparation(const std::string& xml) : document_(parseXml(xml)) {}

  PreparedText run() {
    modernizePoses(document_.get());
    XmlElement* const root = document_->RootElement();
    splits_ = root && !refersToOthers(*root, 1);
    if (root && is(*root, "sdf")) {
      visitParts(root, false);
      for (XmlElement* world = root->FirstChildElement("world"); world;
           world = world->NextSiblingElement("world")) {
        rename(world);
        takeStates(world);
        visitParts(world, true);
      }
    }
    result_.rest = textOf(*document_);
    return std::move(result_);
  }

 private:
  void visitParts(XmlElement* around, bool is_world) {
    XmlElement* next = nullptr;
    for (XmlElement* part = around->FirstChildElement(); part; part = next) {
      next = part->NextSiblingElement();
      if (is(*part, "actor")) {
        addPerson(part);
      } else if (is_world && is(*part, "population")) {
        writeOut(around, part);
      } else if (is(*part, "include") || is(*part, "model")) {
        take(part, is_world);
      }
    }
  }

  void rename(XmlElement* world) {
    const std::string name = attributeOf(*world, "name");
    if (!isReserved(name)) return;
    result_.world_name = name;
    world->SetAttribute("name", (name + ".").c_str());  // not reserved, and still recognisable
  }

  void add(Include include, const XmlElement& from) {
    include.line = from.GetLineNum();
    result_.order.push_back(static_cast<int>(result_.includes.size()));
    result_.includes.push_back(std::move(include));
  }

  void addPerson(XmlElement* actor) {
    Include person;
    person.uri = kPerson;
    person.name = attributeOf(*actor, "name");
    person.pose = placeOf(*actor);
    person.walk = scriptOf(*actor, &result_.warnings);
    result_.warnings.push_back(
        noteAt(*actor, "people look alike here: its skin and animations are left out"));
    add(person, *actor);
    actor->Parent()->DeleteChild(actor);
  }

  void take(XmlElement* part, bool is_world) {
    // <sdf> itself holds one model; the first of several equal models stays.
    const bool is_include = is(*part, "include");
    const auto taken = !splits_     ? std::nullopt
                       : is_include ? readInclude(*part)
                       : is_world   ? readCopy(*part)
                                    : std::nullopt;
    if (!taken) return result_.order.push_back(PreparedText::kOfRest);
    add(*taken, *part);
    part->Parent()->DeleteChild(part);
  }

  std::optional<Include> readCopy(const XmlElement& model) {
    const auto text = readModelText(model);
    if (!text) return std::nullopt;
    const auto [original, is_new] = originals_.try_emplace(text->common, *text);
    if (is_new) return std::nullopt;
    Include copy;
    copy.copy_of = original->second.name;
    copy.name = text->name;
    copy.pose = text->pose * original->second.pose.Inverse();
    return copy;
  }

  /// Takes the states that Gazebo saves at a world's end: poses of models, and models added or
  /// removed.
  void takeStates(XmlElement* world) {
    while (XmlElement* const state = world->FirstChildElement("state")) {
      readPoses(*state);
      if (XmlElement* const came = state->FirstChildElement("insertions")) {
        while (came->FirstChild()) world->InsertEndChild(came->FirstChild());
      }
      if (const XmlElement* const gone = state->FirstChildElement("deletions")) {
        for (const XmlElement* name = gone->FirstChildElement("name"); name;
             name = name->NextSiblingElement("name")) {
          deleteModel(contentOf(name), world);
        }
      }
      world->DeleteChild(state);
    }
  }

  static void deleteModel(const std::string& name, XmlElement* world) {
    XmlElement* next = nullptr;
    for (XmlElement* model = world->FirstChildElement("model"); model; model = next) {
      next = model->NextSiblingElement("model");
      if (attributeOf(*model, "name") == name) world->DeleteChild(model);
    }
  }

  void readPoses(const XmlElement& state) {
    for (const XmlElement* model = state.FirstChildElement("model"); model;
         model = model->NextSiblingElement("model")) {
      const auto pose = parsePose(contentOf(model->FirstChildElement("pose")));
      if (pose) result_.poses[attributeOf(*model, "name")] = *pose;
    }
  }

  void writeOut(XmlElement* world, XmlElement* population) {
    try {
      addClones(world, population, readPopulation(*population));
    } catch (const DescriptionError& error) {
      result_.warnings.push_back(
          noteAt(*population, std::string("this population is left out: ") + error.what()));
    }
    world->DeleteChild(population);
  }

  void addClones(XmlElement* world, XmlElement* population, const Population& from) {
    const bool is_include = is(*from.pattern, "include");
    const auto simple = is_include ? readInclude(*from.pattern) : std::nullopt;
    const std::size_t size = textOf(*from.pattern).size();
    XmlElement* behind = population;
    for (std::size_t i = 0; i < from.poses.size(); ++i) {
      const std::string name = from.name + "_clone_" + std::to_string(i);
      if (splits_ && (simple || (!is_include && i > 0))) {
        Include clone = simple.value_or(Include());
        if (!simple) clone.copy_of = from.name + "_clone_0";
        clone.name = name;
        clone.pose = simple ? from.poses[i] : from.poses[i] * from.poses[0].Inverse();
        add(clone, *from.pattern);
        continue;
      }
      if (size * (i + 1) > kMostBytes) throw DescriptionError("it is too large");
      XmlElement* const clone = from.pattern->DeepClone(document_.get())->ToElement();
      if (!is_include) clone->SetAttribute("name", name.c_str());
      if (is_include) setContent(clone, "name", name);
      setContent(clone, "pose", textOf(from.poses[i]));
      behind = world->InsertAfterChild(behind, clone)->ToElement();
      result_.order.push_back(PreparedText::kOfRest);
    }
  }

  std::unique_ptr<XmlDocument> document_;
  bool splits_ = false;
  PreparedText result_;
  std::map<std::string, ModelText> originals_;  // by the text that their copies share with them
};

}  // namespace

PreparedText prepare(const std::string& xml) { return Preparation(xml).run(); }

void modernizePoses(XmlDocument* document) {
  XmlElement* const root = document->RootElement();
  if (!root) return;
  const bool is_new = root->DoubleAttribute("version", 0) > 1.65;
  forAll(root, [is_new](XmlElement* element) {
    const char* const frame = element->Attribute("frame");
    if (!frame || !is(*element, "pose")) return;
    const std::string name = trimmed(frame);
    if (!name.empty() && !is_new) return;  // conversion handles these
    if (!name.empty() && !element->Attribute("relative_to")) {
      element->SetAttribute("relative_to", name.c_str());
    }
    element->DeleteAttribute("frame");
  });
}

}  // namespace kiva
