// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_checks.h"

#include <set>
#include <string>
#include <utility>

#include "core/sdf_errors.h"
#include "core/sdf_inertia.h"
#include "kiva_plugin_cpp/description.h"

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

void checkModel(const sdf::ElementPtr& model) {
  checkNames(model);
  if (model->HasElement("link") || model->HasElement("model")) return;
  failAt(model, "expected a <link> in <model>");
}

/// What we can build, in one place: a type that is not here is refused by name.
void checkJoint(const sdf::ElementPtr& joint) {
  const std::string type = joint->Get<std::string>("type");
  for (const char* known : {"fixed", "revolute", "continuous", "prismatic"}) {
    if (type == known) return;
  }
  failAt(joint, "joints of type '" + type +
                    "' are not supported; expected fixed, revolute, continuous or prismatic");
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
  if (name == "world" || name == "link") checkNames(element);
  if (name == "model") checkModel(element);
  if (name == "link") repairInertial(element, warnings);
  if (name == "material") dropScript(element);
  if (name == "joint") checkJoint(element);
  if (name == "axis") checkAxis(element);
}

}  // namespace

void checkElements(const sdf::ElementPtr& element, sdf::Errors* warnings) {
  check(element, warnings);
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    // What is inside a plugin is its own affair.
    if (child->GetName() != "plugin") checkElements(child, warnings);
  }
}

sdf::ElementPtr givenChild(const sdf::ElementPtr& element, const std::string& child) {
  const sdf::ElementPtr found = element->FindElement(child);
  return found && found->GetExplicitlySetInFile() ? found : nullptr;
}

}  // namespace kiva
