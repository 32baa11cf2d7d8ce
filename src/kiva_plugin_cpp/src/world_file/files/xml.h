// SPDX-License-Identifier: Apache-2.0
//
// World files as trees, and elements as text again with each on the line where it was.
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
  /// From now on nothing in it is renamed, moved or taken out.
  void setFinal() { is_final_ = true; }

  /// Returns the link, joint, frame or model of that name right below `scope`, an element of an
  /// XmlDocument; null if there is none. Makes an index of all names once the document is final.
  static const XmlElement* findFrame(const XmlElement& scope, const std::string& name);

 private:
  using Frames = std::unordered_map<std::string, const XmlElement*>;

  bool is_final_ = false;
  mutable std::unordered_map<const XmlElement*, Frames> frames_;  // by their scope
};

/// The largest text that is read [byte].
constexpr std::size_t kMostBytes = 20'000'000;

/// Throws SdfError with the line where a text is no XML, is too long, or nests too deep.
std::unique_ptr<XmlDocument> parseXml(const std::string& text);

/// The text of a whole document, every element on its line, without comments. Elements that were
/// added follow on the line of what is before them.
std::string textOf(const XmlDocument& document);
/// The text of one element on one line; `but`, if given, is left out.
std::string textOf(const XmlElement& element, const XmlElement* but = nullptr);

/// Where an element stands that came from another file or from URDF: its user data. Others stand in
/// the document that was given.
struct Source {
  std::string file;  ///< Empty: the document that was given.
  int line = 0;
};
const Source* sourceOf(const XmlElement& element);

/// A message at the file, line and entity of `element`.
Fault noteAt(const XmlElement& element, const std::string& message);
[[noreturn]] void failAt(const XmlElement& element, const std::string& message);

bool is(const XmlElement& element, const char* name);

/// Returns an attribute without the blanks around it; empty if there is none.
std::string attributeOf(const XmlElement& element, const char* name);
/// Returns whether that is an element's name; copies nothing, for searches through many.
bool hasName(const XmlElement& element, const std::string& name);
/// Returns the text in an element, without the blanks around it; empty for null.
std::string contentOf(const XmlElement* element);
std::string trimmed(const std::string& text);
bool startsWith(const std::string& text, const std::string& start);

/// Calls visit(element) for `element` and all below it, but for what is inside plugins: that is
/// their own affair. `visit` may remove children of what it is given.
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
