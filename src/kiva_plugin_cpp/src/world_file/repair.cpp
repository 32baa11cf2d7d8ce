// SPDX-License-Identifier: Apache-2.0
#include "world_file/repair.h"

#include <algorithm>
#include <set>
#include <string>

#include "world_file/errors.h"

namespace kiva {
namespace {

constexpr std::size_t kMostTries = 300;  // parts of a model

std::string kindOf(const XmlElement& element) { return element.Name(); }

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
    const bool is_half = kindOf(*around) == "geometry" || kindOf(*around) == "axis" ||
                         kindOf(*around) == "axis2" ||
                         (around == faulty && kindOf(*around) == "pose");
    if (is_half && parent) return parent;
    if (kWholes.count(kindOf(*around))) return around;
  }
  return faulty;
}

bool isDispensable(const XmlElement* element) {
  return element && kindOf(*element) != "sdf" && kindOf(*element) != "world";
}

/// What a document is made of: the parts of its world, or its model.
std::vector<XmlElement*> partsOf(XmlDocument& document) {
  std::vector<XmlElement*> parts;
  XmlElement* const root = document.RootElement();
  if (!root) return parts;
  const auto add = [&parts](XmlElement* around) {
    for (auto* part = around->FirstChildElement(); part; part = part->NextSiblingElement()) {
      if (kindOf(*part) != "world") parts.push_back(part);
    }
  };
  add(root);
  for (auto* world = root->FirstChildElement("world"); world;
       world = world->NextSiblingElement("world")) {
    add(world);
  }
  return parts;
}

/// Without it its model would be none.
bool isOnlyLink(const XmlElement& element) {
  const tinyxml2::XMLNode* const parent = element.Parent();
  if (kindOf(element) != "link" || parent->FirstChildElement("model")) return false;
  return parent->FirstChildElement("link") == &element && !element.NextSiblingElement("link");
}

/// The parts of a part, those first that cost least.
std::vector<XmlElement*> smallPartsOf(XmlElement* part) {
  static const std::vector<std::string> kKinds = {"collision", "visual", "sensor", "light",
                                                  "plugin",    "joint",  "frame",  "gripper",
                                                  "include",   "link",   "model"};
  std::vector<XmlElement*> found;
  forAll(part, [&](XmlElement* element) {
    if (element == part || isOnlyLink(*element)) return;
    if (std::count(kKinds.begin(), kKinds.end(), kindOf(*element))) found.push_back(element);
  });
  std::stable_sort(found.begin(), found.end(), [](const XmlElement* a, const XmlElement* b) {
    const auto rank = [](const XmlElement* e) {
      return std::find(kKinds.begin(), kKinds.end(), kindOf(*e)) - kKinds.begin();
    };
    return rank(a) < rank(b);
  });
  if (found.size() > kMostTries) found.resize(kMostTries);
  return found;
}

/// Finds what a fault without an address is about.
class Search {
 public:
  Search(const sdf::Error& fault, const FaultOf& fault_of, XmlDocument& document)
      : message_(fault.Message()), fault_of_(fault_of), document_(document) {}

  /// Null if it is in no part.
  XmlElement* run() {
    const std::vector<XmlElement*> parts = partsOf(document_);
    std::size_t from = 0, to = parts.size();
    if (to == 0 || isFaultyWith(0, 0)) return nullptr;
    while (to - from > 1) {
      const std::size_t middle = (from + to) / 2;
      if (isFaultyWith(from, middle)) {
        to = middle;
      } else if (isFaultyWith(middle, to)) {
        from = middle;
      } else {
        return parts[to - 1];  // Two of them don't go together.
      }
    }
    XmlElement* const part = parts[from];
    const std::size_t count = smallPartsOf(part).size();
    for (std::size_t i = 0; i < count; ++i) {
      if (isCuredWithout(from, i)) return smallPartsOf(part)[i];
    }
    return part;
  }

 private:
  /// Only parts from … to − 1 are kept.
  void copyParts(std::size_t from, std::size_t to, XmlDocument* copy) {
    document_.DeepCopy(copy);
    const std::vector<XmlElement*> parts = partsOf(*copy);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i < from || i >= to) parts[i]->Parent()->DeleteChild(parts[i]);
    }
  }

  bool isFaultyWith(std::size_t from, std::size_t to) {
    XmlDocument copy;
    copyParts(from, to, &copy);
    const auto fault = fault_of_(copy);
    return fault && fault->Message() == message_;
  }

  bool isCuredWithout(std::size_t part, std::size_t small_part) {
    XmlDocument copy;
    copyParts(part, part + 1, &copy);
    XmlElement* const out = smallPartsOf(partsOf(copy).front())[small_part];
    out->Parent()->DeleteChild(out);
    return !fault_of_(copy);
  }

  const std::string message_;
  const FaultOf& fault_of_;
  XmlDocument& document_;
};

XmlElement* addressed(const sdf::Error& fault, XmlDocument* document) {
  const std::string path = fault.XmlPath().value_or("");
  const std::string file = fault.FilePath().value_or("");
  const bool is_elsewhere = !file.empty() && file[0] != '<';  // in a file that is included
  if (path.empty() || is_elsewhere) return nullptr;
  XmlElement* found = findElement(*document, path, fault.LineNumber().value_or(0));
  if (!found) found = findElement(*document, path, 0);
  return found ? wholeOf(found) : nullptr;
}

}  // namespace

bool leaveOut(const sdf::Error& fault, const FaultOf& fault_of, XmlDocument* document,
              sdf::Errors* warnings) {
  XmlElement* const at = addressed(fault, document);
  XmlElement* out = at;
  if (!isDispensable(out)) out = Search(fault, fault_of, *document).run();
  if (!isDispensable(out)) return false;
  const std::string file = fault.FilePath().value_or("");
  const bool is_elsewhere = !file.empty() && file[0] != '<';
  const std::string cause = is_elsewhere ? describe(fault, "") : causeOf(fault);
  const std::string message = "this " + kindOf(*out) + " is left out: " + cause;
  warnings->push_back(at ? reworded(fault, message) : noteAt(*out, message));
  out->Parent()->DeleteChild(out);
  return true;
}

}  // namespace kiva
