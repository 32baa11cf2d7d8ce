// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/conversion.h"

#include <set>

#include "world_file/elements/values.h"

namespace kiva {
namespace {

/// Moves a text to another child, unless that exists.
void moveText(XmlElement* from_parent, const char* from, XmlElement* to_parent, const char* to) {
  XmlElement* const source = from_parent ? from_parent->FirstChildElement(from) : nullptr;
  if (!source) return;
  const std::string text = contentOf(source);
  from_parent->DeleteChild(source);
  if (!to_parent->FirstChildElement(to))
    to_parent->InsertNewChildElement(to)->SetText(text.c_str());
}

/// Converts to 1.6: moves gravity and the magnetic field from <physics> to the world.
void takeFromPhysics(XmlElement* world) {
  for (const char* name : {"gravity", "magnetic_field"}) {
    for (XmlElement* physics = world->FirstChildElement("physics"); physics;
         physics = physics->NextSiblingElement("physics")) {
      if (XmlElement* const moved = physics->FirstChildElement(name)) world->InsertEndChild(moved);
    }
  }
}

/// Converts to 1.4: renames the settings of the engine's step.
void renamePhysics(XmlElement* physics) {
  moveText(physics, "update_rate", physics, "real_time_update_rate");
  XmlElement* const ode = physics->FirstChildElement("ode");
  moveText(ode ? ode->FirstChildElement("solver") : nullptr, "dt", physics, "max_step_size");
  moveText(physics->FirstChildElement("bullet"), "dt", physics, "max_step_size");
}

/// Converts to 1.7: the frame of an axis is given by its name. In 1.4 it was the model's.
void nameAxisFrame(XmlElement* axis, bool is_in_model) {
  if (!axis) return;
  if (XmlElement* const flag = axis->FirstChildElement("use_parent_model_frame")) {
    is_in_model |= readFlag(contentOf(flag)).value_or(false);
    axis->DeleteChild(flag);
  }
  if (!is_in_model) return;
  XmlElement* xyz = axis->FirstChildElement("xyz");
  if (!xyz) xyz = axis->InsertNewChildElement("xyz");
  xyz->SetAttribute("expressed_in", "__model__");
}

/// Converts to 1.7: the frame of a pose is given by its name.
void renameFrame(XmlElement* pose) {
  const char* const frame = pose->Attribute("frame");
  if (!frame) return;
  if (!pose->Attribute("relative_to") && !trimmed(frame).empty())
    pose->SetAttribute("relative_to", frame);
  pose->DeleteAttribute("frame");
}

void convertElement(XmlElement* element, double version) {
  if (version < 1.35 && is(*element, "physics")) renamePhysics(element);
  if (version < 1.55 && is(*element, "world")) takeFromPhysics(element);
  if (version < 1.65 && is(*element, "pose")) renameFrame(element);
  if (version < 1.65 && is(*element, "joint")) {
    for (const char* axis : {"axis", "axis2"}) {
      nameAxisFrame(element->FirstChildElement(axis), version < 1.45);
    }
  }
}

}  // namespace

void convert(XmlElement* sdf) {
  static const std::set<std::string> kVersions = {"1.0", "1.2", "1.3", "1.4",  "1.5", "1.6",
                                                  "1.7", "1.8", "1.9", "1.10", "1.11"};
  const std::string version = attributeOf(*sdf, "version");
  if (!kVersions.count(version)) {
    failAt(*sdf, "SDF version '" + version + "' is unknown; expected 1.0 to 1.11");
  }
  const double number = version.size() > 3 ? 1.9 : std::atof(version.c_str());
  forAll(sdf, [&](XmlElement* element) { convertElement(element, number); });
  sdf->SetAttribute("version", "1.9");
}

}  // namespace kiva
