// SPDX-License-Identifier: Apache-2.0
//
// World files as trees, and elements as text on their original lines.
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/errors.h"

namespace kiva {

using XmlElement = tinyxml2::XMLElement;

/// A document that can look up the frames of its models.
class XmlDocument : public tinyxml2::XMLDocument {
 public:
  /// Ends changes: from now on no element is renamed, moved or removed.
  void setFinal() { is_final_ = true; }

  /// Returns the link, joint, frame or model of that name directly below `scope`, an element of an
  /// XmlDocument; null if there is none. Indexes all names once the document is final.
  static const XmlElement* findFrame(const XmlElement& scope, const std::string& name);

 private:
  using Frames = std::unordered_map<std::string, const XmlElement*>;

  bool is_final_ = false;
  mutable std::unordered_map<const XmlElement*, Frames> frames_;  // by their scope
};

/// Size limit of a text [byte].
constexpr std::size_t kMostBytes = 20'000'000;

/// Parses a text. Throws SdfError with the line where it is not XML, too long, or too deeply
/// nested.
std::unique_ptr<XmlDocument> parseXml(const std::string& text);

/// Returns the text of a whole document without comments, every element on its original line.
/// Elements that were added follow on the line of the element before them.
std::string textOf(const XmlDocument& document);
/// Returns the text of one element on one line, without `but`.
std::string textOf(const XmlElement& element, const XmlElement* but = nullptr);

/// The origin of an element from another file or from URDF: its user data. Other elements are in
/// the caller's document.
struct Source {
  std::string file;  ///< Empty = the caller's document.
  int line = 0;
};
const Source* sourceOf(const XmlElement& element);

/// Returns a message at the file, line and entity of `element`.
Fault noteAt(const XmlElement& element, const std::string& message);
[[noreturn]] void failAt(const XmlElement& element, const std::string& message);

bool is(const XmlElement& element, const char* name);

/// Returns an attribute without the blanks around it; empty if there is none.
std::string attributeOf(const XmlElement& element, const char* name);
/// Returns whether an element has that name. It copies nothing, for searches through many elements.
bool hasName(const XmlElement& element, const std::string& name);
/// Returns the text in an element, without the blanks around it; empty for null.
std::string contentOf(const XmlElement* element);
std::string trimmed(const std::string& text);
bool startsWith(const std::string& text, const std::string& start);

/// Calls visit(element) for `element` and all below it, except inside plugins. `visit` may remove
/// children of its element.
template <typename Visit>
void forAll(XmlElement* element, const Visit& visit) {
  visit(element);
  XmlElement* next = nullptr;
  for (XmlElement* child = element->FirstChildElement(); child; child = next) {
    next = child->NextSiblingElement();
    if (std::string(child->Name()) != "plugin") forAll(child, visit);
  }
}

/// Calls visit(child) for each child of that name.
template <typename Visit>
void forEach(const XmlElement& element, const char* name, const Visit& visit) {
  for (const XmlElement* child = element.FirstChildElement(name); child;
       child = child->NextSiblingElement(name)) {
    visit(*child);
  }
}

/// Returns that many finite numbers; nothing for any other text.
std::optional<std::vector<double>> parseNumbers(const std::string& text, std::size_t count);
/// Returns a pose of six finite numbers; nothing for any other text.
std::optional<Pose> parsePose(const std::string& text);
/// Returns a pose as SDF writes it.
std::string textOf(const Pose& pose);

}  // namespace kiva
