// SPDX-License-Identifier: Apache-2.0
#include "world_file/checks.h"

#include <set>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/description.h"
#include "world_file/errors.h"
#include "world_file/inertia.h"
#include "world_file/xml.h"

namespace kiva {
namespace {

/// Names of what is in an element, by kind: links among links, models among models and so on. Of
/// plugins several may have one name.
using Names = std::set<std::pair<std::string, std::string>>;

/// Two shapes of one name are told apart here; nothing refers to them by it.
void rename(const sdf::ElementPtr& part, Names* names, sdf::Errors* warnings) {
  const std::string name = part->Get<std::string>("name");
  std::string free;
  for (int count = 2; free.empty(); ++count) {
    const std::string tried = name + "_" + std::to_string(count);
    if (names->emplace(part->GetName(), tried).second) free = tried;
  }
  warnings->push_back(noteAt(part, "this name is taken; it is called '" + free + "' here"));
  part->GetAttribute("name")->SetFromString(free);
}

/// Returns the fault of a name; empty if it is unique, perhaps after adding it.
std::string faultOfName(const sdf::ElementPtr& part, Names* names, sdf::Errors* warnings) {
  const std::string& kind = part->GetName();
  if (!part->HasAttribute("name") || kind == "plugin") return "";
  if (names->emplace(kind, part->Get<std::string>("name")).second) return "";
  if (kind == "collision" || kind == "visual" || kind == "sensor") {
    rename(part, names, warnings);
    return "";
  }
  return "this name is taken; expected every <" + kind + "> in <" + part->GetParent()->GetName() +
         "> to have a name of its own";
}

/// Returns the fault of a model that holds nothing, perhaps since its include is missing.
std::string faultOfModel(const sdf::ElementPtr& model) {
  const bool is_empty = !model->HasElement("link") && !model->HasElement("model");
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
sdf::ElementPtr findPart(const sdf::ElementPtr& around, const std::string& name) {
  for (auto part = around->GetFirstElement(); part; part = part->GetNextElement()) {
    const std::string& kind = part->GetName();
    const bool is_frame = kind == "link" || kind == "joint" || kind == "frame" || kind == "model";
    if (is_frame && part->HasAttribute("name") && part->Get<std::string>("name") == name) {
      return part;
    }
  }
  return nullptr;
}

/// Returns whether a model or a world has a frame of that name: `link`, `model::link`, or a
/// built-in one.
bool isThere(const sdf::ElementPtr& around, const std::string& name) {
  if (name.empty() || name == "world" || startsWith(name, "__")) return true;
  if (findPart(around, name)) return true;
  const std::size_t colons = name.find("::");
  if (colons == std::string::npos) return false;
  const sdf::ElementPtr model = findPart(around, name.substr(0, colons));
  return model && model->GetName() == "model" && isThere(model, name.substr(colons + 2));
}

/// Returns the model around an element, or the world; null outside of both.
sdf::ElementPtr scopeOf(sdf::ElementPtr element) {
  do {
    element = element->GetParent();
  } while (element && element->GetName() != "model" && element->GetName() != "world");
  return element;
}

/// Returns the name of the frame that an element is relative to, if no such frame exists.
std::string missingReference(const sdf::ElementPtr& element, const sdf::ElementPtr& scope) {
  for (const char* attribute : {"relative_to", "attached_to", "expressed_in"}) {
    if (!element->HasAttribute(attribute)) continue;
    const std::string name = element->Get<std::string>(attribute);
    if (!isThere(scope, name)) return std::string(attribute) + " '" + name + "'";
  }
  return "";
}

/// Returns the fault of an element that is relative to a missing frame, its own parts apart; empty
/// if there is none.
std::string faultOfPlace(const sdf::ElementPtr& part) {
  const sdf::ElementPtr scope = scopeOf(part);
  if (!scope) return "";
  std::string missing = missingReference(part, scope);
  for (const char* name : {"pose", "axis", "axis2"}) {
    auto child = part->FindElement(name);
    if (child && child->GetName() != "pose") child = child->FindElement("xyz");
    if (child && missing.empty()) missing = missingReference(child, scope);
  }
  return missing.empty() ? "" : "its " + missing + " is not there";
}

/// A model may do without these: libsdformat takes its first link, its own frame.
void dropWrongFrames(const sdf::ElementPtr& model, sdf::Errors* warnings) {
  for (const char* attribute : {"canonical_link", "placement_frame"}) {
    if (!model->HasAttribute(attribute)) continue;
    const std::string name = model->Get<std::string>(attribute);
    if (isThere(model, name)) continue;
    warnings->push_back(noteAt(
        model, "its " + std::string(attribute) + " '" + name + "' is not there and is left out"));
    model->RemoveAttribute(attribute);
  }
}

/// libsdformat gives meshes without a file no address.
std::string faultOfShape(const sdf::ElementPtr& part) {
  const sdf::ElementPtr geometry = part->FindElement("geometry");
  const sdf::ElementPtr mesh = geometry ? geometry->FindElement("mesh") : nullptr;
  if (!mesh) return "";
  const sdf::ElementPtr uri = givenChild(mesh, "uri");
  return uri && !uri->Get<std::string>().empty() ? "" : "expected a <uri> in <mesh>";
}

std::string faultOfJoint(const sdf::ElementPtr& joint) {
  const std::string type = joint->Get<std::string>("type");
  if (!isKnownJoint(type)) {
    return "joints of type '" + type +
           "' are not supported; expected fixed, revolute, continuous, prismatic or ball";
  }
  const sdf::ElementPtr axis = joint->FindElement("axis");
  const sdf::ElementPtr xyz = axis ? givenChild(axis, "xyz") : nullptr;
  if (xyz && !(xyz->Get<Vector3>().Length() > 0)) return "expected an axis that points somewhere";
  for (const char* end : {"parent", "child"}) {
    const std::string name = joint->HasElement(end) ? joint->Get<std::string>(end) : "";
    if (!isThere(joint->GetParent(), name))
      return "its " + std::string(end) + " '" + name + "' is not there";
  }
  return "";
}

/// Returns the fault of a part that its world can do without; empty if there is none.
std::string faultOf(const sdf::ElementPtr& part) {
  const std::string& kind = part->GetName();
  const std::string& around = part->GetParent()->GetName();
  if (kind == "joint" && around == "model") return faultOfJoint(part);
  if (kind == "collision" || kind == "visual") return faultOfShape(part);
  if (kind != "model") return "";
  const std::string fault = faultOfModel(part);
  if (!fault.empty() && around == "sdf") failAt(part, fault);  // There is nothing else.
  return fault;
}

/// libsdformat refuses scripts that only a renderer could run.
void dropScript(const sdf::ElementPtr& material) {
  if (const sdf::ElementPtr script = material->FindElement("script")) material->RemoveChild(script);
}

void leaveOut(const sdf::ElementPtr& part, const std::string& fault, sdf::Errors* warnings) {
  warnings->push_back(noteAt(part, "this " + part->GetName() + " is left out: " + fault));
  part->GetParent()->RemoveChild(part);
}

/// Parts and their parts, by themselves.
void checkParts(const sdf::ElementPtr& element, sdf::Errors* warnings) {
  if (element->GetName() == "link") repairInertial(element, warnings);
  if (element->GetName() == "material") dropScript(element);
  Names names;
  sdf::ElementPtr next;
  for (auto child = element->GetFirstElement(); child; child = next) {
    next = child->GetNextElement();
    if (child->GetName() == "plugin") continue;  // What is inside is its own affair.
    checkParts(child, warnings);
    std::string fault = faultOf(child);
    if (fault.empty()) fault = faultOfName(child, &names, warnings);
    if (!fault.empty()) leaveOut(child, fault, warnings);
  }
}

/// What is placed by something else; true if something was left out, which others may be placed by.
bool checkPlaces(const sdf::ElementPtr& element, sdf::Errors* warnings) {
  bool has_changed = false;
  if (element->GetName() == "model") dropWrongFrames(element, warnings);
  sdf::ElementPtr next;
  for (auto child = element->GetFirstElement(); child; child = next) {
    next = child->GetNextElement();
    if (child->GetName() == "plugin") continue;
    std::string fault = child->GetName() == "pose" ? "" : faultOfPlace(child);
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

void checkElements(const sdf::ElementPtr& root, sdf::Errors* warnings) {
  checkParts(root, warnings);
  while (checkPlaces(root, warnings)) continue;
}

sdf::ElementPtr givenChild(const sdf::ElementPtr& element, const std::string& child) {
  const sdf::ElementPtr found = element->FindElement(child);
  return found && found->GetExplicitlySetInFile() ? found : nullptr;
}

}  // namespace kiva
