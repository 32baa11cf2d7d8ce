// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "world_file/tag_scanner.h"

namespace kiva {

/// An element as a part of a text.
struct XmlPart {
  std::string_view name;
  std::string_view attributes;
  std::string_view whole;   ///< From `<` to `>`, all.
  std::string_view inside;  ///< Between its tags; empty for `<a/>`.

  bool isLeaf() const { return inside.find('<') == std::string_view::npos; }
};

/// The element whose opening tag the scanner stands at, which then stands at its closing one.
/// Nothing if that never comes.
std::optional<XmlPart> takePart(std::string_view xml, TagScanner* scanner);

/// The elements in a text, those inside them left alone. Nothing if it is no XML.
std::optional<std::vector<XmlPart>> partsOf(std::string_view inside);

/// The first part of that name; null if there is none.
const XmlPart* findPart(const std::vector<XmlPart>& parts, std::string_view name);

/// The value of an attribute as written; nothing if it is not there or holds an entity.
std::optional<std::string> attributeOf(const XmlPart& part, std::string_view attribute);

std::string trimmed(std::string_view text);
/// Six finite numbers.
std::optional<Pose> parsePose(const std::string& text);
/// So many finite numbers, and nothing else.
std::optional<std::vector<double>> parseNumbers(const std::string& text, std::size_t count);

}  // namespace kiva
