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

/// Returns the part that a faulty value costs: the one around it if the other values there make no
/// sense without it, else the value itself.
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

/// A fault, its element, and the element to leave out for it.
struct LocatedFault {
  XmlElement* at = nullptr;
  Fault fault;
  XmlElement* out = nullptr;
};

bool isDispensable(const XmlElement& element) {
  return !is(element, "sdf") && !is(element, "world");
}

void drop(const LocatedFault& located, Faults* left_out) {
  left_out->push_back(reworded(located.fault, "this " + std::string(located.out->Name()) +
                                                  " is left out: " + located.fault.message));
  located.out->Parent()->DeleteChild(located.out);
}

/// Searches for faults. With `left_out` it removes the faulty parts and continues after them.
class Validation {
 public:
  explicit Validation(Faults* left_out) : left_out_(left_out) {}

  /// Returns the first fault in `element` or below it that costs the element itself or one around
  /// it.
  std::optional<LocatedFault> check(XmlElement* element, const ElementFormat& format, char count) {
    if (auto located = checkOwn(element, format, count)) return located;
    if (format.is_open) return std::nullopt;
    XmlElement* next = nullptr;
    for (XmlElement* child = element->FirstChildElement(); child; child = next) {
      next = child->NextSiblingElement();
      const auto* const known = format.child(child->Name());
      if (!known) continue;
      const auto located = check(child, *known->format, known->count);
      if (!located) continue;
      if (!left_out_ || located->out != child || !isDispensable(*child)) return located;
      drop(*located, left_out_);
    }
    return std::nullopt;
  }

 private:
  static std::optional<LocatedFault> at(XmlElement* element, const std::string& message) {
    if (message.empty()) return std::nullopt;
    return LocatedFault{element, noteAt(*element, message), wholeOf(element)};
  }

  std::optional<LocatedFault> checkOwn(XmlElement* element, const ElementFormat& format,
                                       char count) {
    if (format.value) {
      if (auto located = at(element, faultOfText(*element, *format.value, count))) return located;
    }
    for (const AttributeFormat& attribute : format.attributes) {
      const char* const content = element->Attribute(attribute.name.c_str());
      if (!content && attribute.is_required) {
        return at(element, "Required attribute[" + attribute.name + "] in element[" + format.name +
                               "] is not specified in SDF");
      }
      if (!content) continue;
      const std::string text = trimmed(content);
      if (text.empty() && attribute.is_required) {
        return at(element, "Empty string used when setting a required parameter. Key[" +
                               attribute.name + "]");
      }
      if (auto located = at(element, faultOfValue(text, attribute.name, attribute.value)))
        return located;
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

  /// Returns the fault of a name that SDF reserves; empty if it is not reserved.
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

/// Reports elements that SDF does not know, except those with a namespace, which are for other
/// programs.
void reportUnknown(const XmlElement& element, const ElementFormat& format, Faults* unknown) {
  if (format.is_open) return;
  for (const XmlElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    if (const auto* const known = format.child(child->Name())) {
      reportUnknown(*child, *known->format, unknown);
    } else if (!std::strchr(child->Name(), ':')) {
      unknown->push_back(noteAt(*child, "XML Element[" + std::string(child->Name()) +
                                            "], child of element[" + format.name +
                                            "], not defined in SDF"));
    }
  }
}

}  // namespace

std::optional<Fault> firstFault(XmlElement* sdf) {
  auto located = Validation(nullptr).check(sdf, sdfFormat(), '!');
  if (!located) return std::nullopt;
  return located->fault;
}

void validate(XmlElement* sdf, Faults* left_out, Faults* unknown) {
  if (const auto located = Validation(left_out).check(sdf, sdfFormat(), '!')) {
    throw SdfError(located->fault);
  }
  reportUnknown(*sdf, sdfFormat(), unknown);
}

}  // namespace kiva
