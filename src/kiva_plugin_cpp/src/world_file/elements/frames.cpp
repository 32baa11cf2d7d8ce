// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/frames.h"

#include "world_file/elements/values.h"

namespace kiva {
namespace {

constexpr int kMostSteps = 1000;  // limit from frame to frame; a longer chain counts as a circle

const XmlElement& requiredPart(const XmlElement& scope, const std::string& name) {
  const XmlElement* const part = XmlDocument::findFrame(scope, name);
  if (!part) failAt(scope, "there is no frame '" + name + "' in it");
  return *part;
}

const XmlElement& scopeOf(const XmlElement& part) {
  const tinyxml2::XMLNode* node = part.Parent();
  while (node->ToElement() && !is(*node->ToElement(), "model") &&
         !is(*node->ToElement(), "world") && node->Parent()->ToElement()) {
    node = node->Parent();
  }
  return *node->ToElement();
}

/// Resolves frames and limits the number of its steps.
class FrameSearch {
 public:
  Pose frame(const XmlElement& scope, const std::string& name) {
    if (++steps_ > kMostSteps)
      failAt(scope, "its frames refer to each other in a circle, or through more than 1000 others");
    if (name.empty() || name == "world" || name == "__root__" || name == "__model__")
      return Pose::Zero;
    const std::size_t colons = name.find("::");
    const std::string first_name = name.substr(0, colons);
    const XmlElement& part = requiredPart(scope, first_name);
    const Pose first = around(part);
    if (colons == std::string::npos) return first;
    return first * frame(part, name.substr(colons + 2));
  }

  Pose around(const XmlElement& part) {
    const XmlElement* const pose_element = part.FirstChildElement("pose");
    const std::string name = pose_element ? attributeOf(*pose_element, "relative_to") : "";
    const Pose pose = valueOfPose(pose_element);
    const std::string base = name.empty() ? usualFrame(part) : name;
    const Pose result = base.empty() ? pose : frame(scopeOf(part), base) * pose;
    if (!is(part, "model")) return result;
    const std::string placed = attributeOf(part, "placement_frame");
    return placed.empty() ? result : result * frame(part, placed).Inverse();
  }

  std::string link(const XmlElement& model, const std::string& name) {
    if (++steps_ > kMostSteps)
      failAt(model, "its frames refer to each other in a circle, or through more than 1000 others");
    if (name == "world") return name;
    if (name == "__model__") return canonicalLinkOf(model);
    const std::size_t colons = name.find("::");
    const std::string first = name.substr(0, colons);
    const XmlElement& part = requiredPart(model, first);
    if (colons != std::string::npos) return first + "::" + link(part, name.substr(colons + 2));
    if (is(part, "link")) return name;
    if (is(part, "joint")) return link(model, contentOf(part.FirstChildElement("child")));
    if (is(part, "model")) return first + "::" + canonicalLinkOf(part);
    const std::string attached = attributeOf(part, "attached_to");
    return attached.empty() ? canonicalLinkOf(model) : link(model, attached);
  }

 private:
  /// Returns the default frame of a part's pose; empty for the frame of the part around it.
  static std::string usualFrame(const XmlElement& part) {
    if (is(part, "joint")) return contentOf(part.FirstChildElement("child"));
    if (is(part, "frame")) return attributeOf(part, "attached_to");
    return "";
  }

  int steps_ = 0;
};

}  // namespace

Pose poseAround(const XmlElement& part) {
  const XmlElement* const pose_element = part.FirstChildElement("pose");
  const std::string name = pose_element ? attributeOf(*pose_element, "relative_to") : "";
  const XmlElement* const link = part.Parent()->ToElement();
  if (!link || !is(*link, "link")) return FrameSearch().around(part);
  if (name.empty()) return valueOfPose(pose_element);
  const XmlElement& scope = scopeOf(part);
  return FrameSearch().around(*link).Inverse() * (frameIn(scope, name) * valueOfPose(pose_element));
}

Pose frameIn(const XmlElement& scope, const std::string& name) {
  return FrameSearch().frame(scope, name);
}

std::string linkOf(const XmlElement& model, const std::string& name) {
  return FrameSearch().link(model, name);
}

std::string canonicalLinkOf(const XmlElement& model) {
  const std::string named = attributeOf(model, "canonical_link");
  if (!named.empty()) return named;
  if (const XmlElement* const link = model.FirstChildElement("link"))
    return attributeOf(*link, "name");
  for (const XmlElement* nested = model.FirstChildElement("model"); nested;
       nested = nested->NextSiblingElement("model")) {
    const std::string inside = canonicalLinkOf(*nested);
    if (!inside.empty()) return attributeOf(*nested, "name") + "::" + inside;
  }
  return "";
}

}  // namespace kiva
