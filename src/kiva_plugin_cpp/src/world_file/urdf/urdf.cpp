// SPDX-License-Identifier: Apache-2.0
#include "world_file/urdf/urdf.h"

#include <algorithm>

#include "world_file/files/xml.h"

namespace kiva {

std::string withInertias(const std::string& urdf) {
  try {
    const auto document = parseXml(urdf);
    XmlElement* const robot = document->RootElement();
    for (XmlElement* link = robot->FirstChildElement("link"); link;
         link = link->NextSiblingElement("link")) {
      if (attributeOf(*link, "name") == "world" || link->FirstChildElement("inertial")) continue;
      XmlElement* const inertial = link->InsertNewChildElement("inertial");
      inertial->InsertNewChildElement("mass")->SetAttribute("value", 1);
      XmlElement* const inertia = inertial->InsertNewChildElement("inertia");
      for (const char* moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1);
      for (const char* product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0);
    }
    return textOf(*document);
  } catch (const SdfError&) {
    return urdf;  // Reported where it is read.
  }
}

void letStand(ModelInstance* model) {
  const ModelDescription& before = *model->description;
  const bool moves = std::any_of(before.joints.begin(), before.joints.end(),
                                 [](const Joint& j) { return j.kind != Joint::Kind::kFixed; });
  if (before.is_static || moves) return;
  auto hall = std::make_shared<ModelDescription>(before);
  hall->is_static = true;
  hall->joints.clear();
  model->description = std::move(hall);
}

}  // namespace kiva
