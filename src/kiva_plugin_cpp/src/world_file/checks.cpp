// SPDX-License-Identifier: Apache-2.0
#include "world_file/checks.h"

#include <set>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/description.h"
#include "world_file/errors.h"
#include "world_file/inertia.h"

namespace kiva {
namespace {

/// Of links among links, models among models and so on; of plugins several may have one name.
void checkNames(const sdf::ElementPtr& parent) {
  std::set<std::pair<std::string, std::string>> names;
  for (auto child = parent->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->HasAttribute("name") || child->GetName() == "plugin") continue;
    if (names.emplace(child->GetName(), child->Get<std::string>("name")).second) continue;
    failAt(child, "this name is taken; expected every <" + child->GetName() + "> in <" +
                      parent->GetName() + "> to have a name of its own");
  }
}

/// A model that holds nothing, perhaps since what it included is not there.
std::string faultOfModel(const sdf::ElementPtr& model) {
  const bool is_empty = !model->HasElement("link") && !model->HasElement("model");
  return is_empty ? "expected a <link> in <model>" : "";
}

/// What we can build, in one place.
bool isKnownJoint(const std::string& type) {
  static const std::set<std::string> kTypes = {"fixed", "revolute", "continuous", "prismatic",
                                               "ball"};
  return kTypes.count(type) > 0;
}

/// Whether a part of the model around `joint` bears the name, or the first part of `name::…`.
bool isThere(const sdf::ElementPtr& joint, const std::string& name) {
  if (name.empty() || name == "world" || name.compare(0, 2, "__") == 0) return true;
  const std::string first = name.substr(0, name.find("::"));
  for (auto part = joint->GetParent()->GetFirstElement(); part; part = part->GetNextElement()) {
    if (!part->HasAttribute("name")) continue;
    const std::string its_name = part->Get<std::string>("name");
    if (its_name == first || its_name == name) return true;
  }
  return false;
}

std::string faultOfJoint(const sdf::ElementPtr& joint) {
  const std::string type = joint->Get<std::string>("type");
  if (!isKnownJoint(type)) {
    return "joints of type '" + type +
           "' are not supported; expected fixed, revolute, continuous, prismatic or ball";
  }
  for (const char* end : {"parent", "child"}) {
    const std::string name = joint->HasElement(end) ? joint->Get<std::string>(end) : "";
    if (!isThere(joint, name)) return "its " + std::string(end) + " '" + name + "' is not there";
  }
  return "";
}

/// What is wrong with a part that its world can do without; empty: nothing.
std::string faultOf(const sdf::ElementPtr& part) {
  const std::string& around = part->GetParent()->GetName();
  if (part->GetName() == "joint" && around == "model") return faultOfJoint(part);
  if (part->GetName() != "model") return "";
  const std::string fault = faultOfModel(part);
  if (!fault.empty() && around == "sdf") failAt(part, fault);  // There is nothing else.
  return fault;
}

void checkAxis(const sdf::ElementPtr& axis) {
  const sdf::ElementPtr xyz = givenChild(axis, "xyz");
  if (!xyz || xyz->Get<Vector3>().Length() > 0) return;
  failAt(xyz, "expected an axis that points somewhere");
}

/// libsdformat refuses scripts that only a renderer could run.
void dropScript(const sdf::ElementPtr& material) {
  if (const sdf::ElementPtr script = material->FindElement("script")) material->RemoveChild(script);
}

void check(const sdf::ElementPtr& element, sdf::Errors* warnings) {
  const std::string& name = element->GetName();
  if (name == "world" || name == "model" || name == "link") checkNames(element);
  if (name == "link") repairInertial(element, warnings);
  if (name == "material") dropScript(element);
  if (name == "axis") checkAxis(element);
}

}  // namespace

void checkElements(const sdf::ElementPtr& element, sdf::Errors* warnings) {
  check(element, warnings);
  sdf::ElementPtr next;
  for (auto child = element->GetFirstElement(); child; child = next) {
    next = child->GetNextElement();
    if (child->GetName() == "plugin") continue;  // What is inside is its own affair.
    checkElements(child, warnings);
    const std::string fault = faultOf(child);
    if (fault.empty()) continue;
    warnings->push_back(noteAt(child, "this " + child->GetName() + " is left out: " + fault));
    element->RemoveChild(child);
  }
}

sdf::ElementPtr givenChild(const sdf::ElementPtr& element, const std::string& child) {
  const sdf::ElementPtr found = element->FindElement(child);
  return found && found->GetExplicitlySetInFile() ? found : nullptr;
}

}  // namespace kiva
