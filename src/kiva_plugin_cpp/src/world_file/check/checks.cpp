// SPDX-License-Identifier: Apache-2.0
#include "world_file/check/checks.h"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/description.h"
#include "world_file/elements/inertia.h"
#include "world_file/elements/values.h"
#include "world_file/files/errors.h"

namespace kiva {
namespace {

/// A part's kind and name; a name is taken by parts of the same kind alone. Plugins may share a
/// name.
using KindAndName = std::pair<std::string, std::string>;
struct Names {
  std::set<KindAndName> taken;
  std::map<KindAndName, int> counts;  ///< Highest n of the names `name_n` that were added.

  bool add(const std::string& kind, const std::string& name) {
    return taken.emplace(kind, name).second;
  }
};

/// Makes a shape's name unique; nothing refers to shapes by name.
void rename(XmlElement* part, Names* names, Faults* warnings) {
  const std::string name = attributeOf(*part, "name");
  std::string free;
  int& count = names->counts.try_emplace({part->Name(), name}, 1).first->second;
  while (free.empty()) {
    const std::string tried = name + "_" + std::to_string(++count);
    if (names->add(part->Name(), tried)) free = tried;
  }
  warnings->push_back(noteAt(*part, "this name is taken; it is called '" + free + "' here"));
  part->SetAttribute("name", free.c_str());
}

/// Returns the fault of a name; empty if it is unique, perhaps after adding it.
std::string faultOfName(XmlElement* part, Names* names, Faults* warnings) {
  const std::string kind = part->Name();
  if (!part->Attribute("name") || kind == "plugin") return "";
  if (names->add(kind, attributeOf(*part, "name"))) return "";
  if (kind == "collision" || kind == "visual" || kind == "sensor") {
    rename(part, names, warnings);
    return "";
  }
  return "this name is taken; expected every <" + kind + "> in <" +
         part->Parent()->ToElement()->Name() + "> to have a name of its own";
}

/// Returns the fault of a model that holds nothing, perhaps since its include is missing.
std::string faultOfModel(XmlElement* model) {
  const bool is_empty = !model->FirstChildElement("link") && !model->FirstChildElement("model");
  return is_empty ? "expected a <link> in <model>" : "";
}

/// Returns whether joints of a type can be built.
bool isKnownJoint(const std::string& type) {
  static const std::set<std::string> kTypes = {"fixed", "revolute", "continuous", "prismatic",
                                               "ball"};
  return kTypes.count(type) > 0;
}

/// Returns the part of that name that poses in a model or a world can be relative to; null if there
/// is none.
XmlElement* findPart(XmlElement* around, const std::string& name) {
  for (auto part = around->FirstChildElement(); part; part = part->NextSiblingElement()) {
    if (!part->Attribute("name") || !hasName(*part, name)) continue;
    const std::string kind = part->Name();
    if (kind == "link" || kind == "joint" || kind == "frame" || kind == "model") return part;
  }
  return nullptr;
}

/// Returns whether a model or a world has a frame of that name: `link`, `model::link`, or a
/// built-in one.
bool isThere(XmlElement* around, const std::string& name) {
  if (name.empty() || name == "world" || startsWith(name, "__")) return true;
  if (findPart(around, name)) return true;
  const std::size_t colons = name.find("::");
  if (colons == std::string::npos) return false;
  XmlElement* const model = findPart(around, name.substr(0, colons));
  return model && is(*model, "model") && isThere(model, name.substr(colons + 2));
}

/// Returns the model around an element, or the world; null outside of both.
XmlElement* scopeOf(XmlElement* element) {
  do {
    element = element->Parent() ? element->Parent()->ToElement() : nullptr;
  } while (element && !is(*element, "model") && !is(*element, "world"));
  return element;
}

/// Returns the name of the frame that an element is relative to, if no such frame exists.
std::string missingReference(XmlElement* element, XmlElement* scope) {
  for (const char* attribute : {"relative_to", "attached_to", "expressed_in"}) {
    if (!element->Attribute(attribute)) continue;
    const std::string name = attributeOf(*element, attribute);
    if (!isThere(scope, name)) return std::string(attribute) + " '" + name + "'";
  }
  return "";
}

/// Returns the fault of an element that is relative to a missing frame, its own parts apart; empty
/// if there is none.
std::string faultOfPlace(XmlElement* part) {
  XmlElement* const scope = scopeOf(part);
  if (!scope) return "";
  std::string missing = missingReference(part, scope);
  for (const char* name : {"pose", "axis", "axis2"}) {
    auto child = part->FirstChildElement(name);
    if (child && !is(*child, "pose")) child = child->FirstChildElement("xyz");
    if (child && missing.empty()) missing = missingReference(child, scope);
  }
  return missing.empty() ? "" : "its " + missing + " is not there";
}

/// Removes faulty references to frames that a model can do without: its first link and its own
/// frame take their place.
void dropWrongFrames(XmlElement* model, Faults* warnings) {
  for (const char* attribute : {"canonical_link", "placement_frame"}) {
    if (!model->Attribute(attribute)) continue;
    const std::string name = attributeOf(*model, attribute);
    if (isThere(model, name)) continue;
    warnings->push_back(noteAt(
        *model, "its " + std::string(attribute) + " '" + name + "' is not there and is left out"));
    model->DeleteAttribute(attribute);
  }
}

std::string faultOfShape(XmlElement* part) {
  XmlElement* const geometry = part->FirstChildElement("geometry");
  XmlElement* const mesh = geometry ? geometry->FirstChildElement("mesh") : nullptr;
  if (!mesh) return "";
  XmlElement* const uri = mesh->FirstChildElement("uri");
  return uri && !contentOf(uri).empty() ? "" : "expected a <uri> in <mesh>";
}

std::string faultOfJoint(XmlElement* joint) {
  const std::string type = attributeOf(*joint, "type");
  if (!isKnownJoint(type)) {
    return "joints of type '" + type +
           "' are not supported; expected fixed, revolute, continuous, prismatic or ball";
  }
  XmlElement* const axis = joint->FirstChildElement("axis");
  XmlElement* const xyz = axis ? axis->FirstChildElement("xyz") : nullptr;
  if (xyz && !(vectorIn(*xyz).Length() > 0)) return "expected an axis that points somewhere";
  for (const char* end : {"parent", "child"}) {
    const std::string name = contentOf(joint->FirstChildElement(end));
    if (!isThere(joint->Parent()->ToElement(), name))
      return "its " + std::string(end) + " '" + name + "' is not there";
  }
  return "";
}

/// Returns the fault of a part that its world can do without; empty if there is none.
std::string faultOf(XmlElement* part) {
  const std::string kind = part->Name();
  const std::string around = part->Parent()->ToElement()->Name();
  if (kind == "joint" && around == "model") return faultOfJoint(part);
  if (kind == "collision" || kind == "visual") return faultOfShape(part);
  if (kind != "model") return "";
  const std::string fault = faultOfModel(part);
  if (!fault.empty() && around == "sdf") failAt(*part, fault);  // There is nothing else.
  return fault;
}

/// Removes a script, which only a renderer could run.
void dropScript(XmlElement* material) {
  if (XmlElement* const script = material->FirstChildElement("script"))
    material->DeleteChild(script);
}

void leaveOut(XmlElement* part, const std::string& fault, Faults* warnings) {
  warnings->push_back(
      noteAt(*part, "this " + std::string(part->Name()) + " is left out: " + fault));
  part->Parent()->DeleteChild(part);
}

/// Checks each part by itself, then its parts.
void checkParts(XmlElement* element, Faults* warnings) {
  if (is(*element, "link")) repairInertial(element, warnings);
  if (is(*element, "material")) dropScript(element);
  Names names;
  XmlElement* next;
  for (auto child = element->FirstChildElement(); child; child = next) {
    next = child->NextSiblingElement();
    if (is(*child, "plugin")) continue;  // SDF does not define its content.
    checkParts(child, warnings);
    std::string fault = faultOf(child);
    if (fault.empty()) fault = faultOfName(child, &names, warnings);
    if (!fault.empty()) leaveOut(child, fault, warnings);
  }
}

/// Removes parts whose place depends on a missing frame. Returns whether one was removed, on which
/// others may depend.
bool checkPlaces(XmlElement* element, Faults* warnings) {
  bool has_changed = false;
  if (is(*element, "model")) dropWrongFrames(element, warnings);
  XmlElement* next;
  for (auto child = element->FirstChildElement(); child; child = next) {
    next = child->NextSiblingElement();
    if (is(*child, "plugin")) continue;
    std::string fault = is(*child, "pose") ? "" : faultOfPlace(child);
    if (fault.empty()) {
      has_changed |= checkPlaces(child, warnings);
      fault = faultOf(child);  // it may hold nothing by now
    }
    if (fault.empty()) continue;
    leaveOut(child, fault, warnings);
    has_changed = true;
  }
  return has_changed;
}

}  // namespace

void checkElements(XmlElement* root, Faults* warnings) {
  checkParts(root, warnings);
  // Number of rounds. A longer chain costs its model, whose frames are missing when they are looked
  // up.
  constexpr int kMostRounds = 20;
  for (int round = 0; round < kMostRounds && checkPlaces(root, warnings); ++round) continue;
}

}  // namespace kiva
