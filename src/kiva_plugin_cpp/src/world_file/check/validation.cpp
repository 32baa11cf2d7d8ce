// SPDX-License-Identifier: Apache-2.0
#include "world_file/check/validation.h"

#include <cstring>
#include <set>

#include "world_file/elements/values.h"

namespace kiva {
namespace {

XmlElement* parentOf(XmlElement* element) {
  tinyxml2::XMLNode* const parent = element->Parent();
  return parent ? parent->ToElement() : nullptr;
}

/// A value without which its neighbours make no sense goes with the part that they are all of.
XmlElement* wholeOf(XmlElement* faulty) {
  static const std::set<std::string> kWholes = {"sensor", "light",  "inertia", "include",
                                                "plugin", "frame",  "gripper", "projector",
                                                "scene",  "script", "gui",     "particle_emitter"};
  for (XmlElement* around = faulty; around; around = parentOf(around)) {
    XmlElement* const parent = parentOf(around);
    const bool is_half = is(*around, "geometry") || is(*around, "axis") || is(*around, "axis2") ||
                         (around == faulty && is(*around, "pose"));
    if (is_half && parent) return parent;
    if (kWholes.count(around->Name())) return around;
  }
  return faulty;
}

/// A fault, the element that it is at, and the one that goes with it.
struct Found {
  XmlElement* at = nullptr;
  Fault fault;
  XmlElement* out = nullptr;
};

bool isDispensable(const XmlElement& element) {
  return !is(element, "sdf") && !is(element, "world");
}

void drop(const Found& found, Faults* left_out) {
  left_out->push_back(reworded(found.fault, "this " + std::string(found.out->Name()) +
                                                " is left out: " + found.fault.message));
  found.out->Parent()->DeleteChild(found.out);
}

/// Looks for faults; with `left_out` it drops what is faulty, and goes on where that was.
class Validation {
 public:
  explicit Validation(Faults* left_out) : left_out_(left_out) {}

  /// The first fault in `element` or below it that costs the element itself, or one around it.
  std::optional<Found> check(XmlElement* element, const ElementFormat& format, char count) {
    if (auto found = checkOwn(element, format, count)) return found;
    if (format.is_open) return std::nullopt;
    XmlElement* next = nullptr;
    for (XmlElement* child = element->FirstChildElement(); child; child = next) {
      next = child->NextSiblingElement();
      const auto* const known = format.child(child->Name());
      if (!known) continue;
      const auto found = check(child, *known->format, known->count);
      if (!found) continue;
      if (!left_out_ || found->out != child || !isDispensable(*child)) return found;
      drop(*found, left_out_);
    }
    return std::nullopt;
  }

 private:
  static std::optional<Found> at(XmlElement* element, const std::string& message) {
    if (message.empty()) return std::nullopt;
    return Found{element, noteAt(*element, message), wholeOf(element)};
  }

  std::optional<Found> checkOwn(XmlElement* element, const ElementFormat& format, char count) {
    if (format.value) {
      if (auto found = at(element, faultOfText(*element, *format.value, count))) return found;
    }
    for (const AttributeFormat& attribute : format.attributes) {
      const char* const given = element->Attribute(attribute.name.c_str());
      if (!given && attribute.is_required) {
        return at(element, "Required attribute[" + attribute.name + "] in element[" + format.name +
                               "] is not specified in SDF");
      }
      if (!given) continue;
      const std::string text = trimmed(given);
      if (text.empty() && attribute.is_required) {
        return at(element, "Empty string used when setting a required parameter. Key[" +
                               attribute.name + "]");
      }
      if (auto found = at(element, faultOfValue(text, attribute.name, attribute.value)))
        return found;
    }
    const bool is_alone = !is(*element, "model") || !parentOf(element) ||
                          !is(*parentOf(element), "sdf") ||
                          !element->PreviousSiblingElement("model");
    if (!is_alone) return at(element, "Root object can only contain one model");
    return at(element, faultOfName(*element));
  }

  static std::string faultOfText(const XmlElement& element, const ValueFormat& format, char count) {
    const std::string text = contentOf(&element);
    if (text.empty()) {
      return count == '!' || count == '+'
                 ? "Empty string used when setting a required parameter. Key[" +
                       std::string(element.Name()) + "]"
                 : "";
    }
    return format.type == 'p' ? faultOfPoseText(element)
                              : faultOfValue(text, element.Name(), format);
  }

  /// SDF keeps some names to itself.
  static std::string faultOfName(const XmlElement& element) {
    static const std::set<std::string> kNamed = {"world", "model", "link",      "joint",
                                                 "frame", "light", "collision", "visual"};
    if (!kNamed.count(element.Name())) return "";
    const std::string name = attributeOf(element, "name");
    const bool is_internal = name.size() >= 4 && name.compare(0, 2, "__") == 0 &&
                             name.compare(name.size() - 2, 2, "__") == 0;
    if (name != "world" && !is_internal) return "";
    return "The supplied " + std::string(element.Name()) + " name [" + name + "] is reserved";
  }

  Faults* left_out_;
};

/// Tells of elements that SDF does not know; those with a namespace are for other programs.
void tellUnknown(const XmlElement& element, const ElementFormat& format, Faults* unknown) {
  if (format.is_open) return;
  for (const XmlElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    if (const auto* const known = format.child(child->Name())) {
      tellUnknown(*child, *known->format, unknown);
    } else if (!std::strchr(child->Name(), ':')) {
      unknown->push_back(noteAt(*child, "XML Element[" + std::string(child->Name()) +
                                            "], child of element[" + format.name +
                                            "], not defined in SDF"));
    }
  }
}

}  // namespace

std::optional<Fault> firstFault(XmlElement* sdf) {
  auto found = Validation(nullptr).check(sdf, sdfFormat(), '!');
  if (!found) return std::nullopt;
  return found->fault;
}

void validate(XmlElement* sdf, Faults* left_out, Faults* unknown) {
  if (const auto found = Validation(left_out).check(sdf, sdfFormat(), '!')) {
    throw SdfError(found->fault);
  }
  tellUnknown(*sdf, sdfFormat(), unknown);
}

}  // namespace kiva
