// SPDX-License-Identifier: Apache-2.0
#include "world_file/xml_parts.h"

#include <cmath>
#include <sstream>

namespace kiva {
namespace {

constexpr const char* kBlanks = " \t\r\n";

}  // namespace

std::optional<XmlPart> takePart(std::string_view xml, TagScanner* scanner) {
  XmlPart part{scanner->name, scanner->attributes, {}, {}};
  const std::size_t begin = scanner->begin, inside = scanner->end;
  std::vector<std::string_view> open{scanner->name};
  if (scanner->closes) open.clear();
  while (!open.empty()) {
    if (!scanner->next()) return std::nullopt;
    if (scanner->opens && !scanner->closes) open.push_back(scanner->name);
    if (scanner->opens || !scanner->closes) continue;
    if (open.back() != scanner->name) return std::nullopt;
    open.pop_back();
  }
  part.whole = xml.substr(begin, scanner->end - begin);
  if (scanner->begin >= inside) part.inside = xml.substr(inside, scanner->begin - inside);
  return part;
}

std::optional<std::vector<XmlPart>> partsOf(std::string_view inside) {
  std::vector<XmlPart> parts;
  TagScanner scanner(inside);
  while (scanner.next()) {
    if (!scanner.opens) return std::nullopt;
    const auto part = takePart(inside, &scanner);
    if (!part) return std::nullopt;
    parts.push_back(*part);
  }
  return parts;
}

const XmlPart* findPart(const std::vector<XmlPart>& parts, std::string_view name) {
  for (const XmlPart& part : parts) {
    if (part.name == name) return &part;
  }
  return nullptr;
}

std::optional<std::string> attributeOf(const XmlPart& part, std::string_view attribute) {
  const std::string_view text = part.attributes;
  for (std::size_t at = 0;;) {
    at = text.find_first_not_of(kBlanks, at);
    const std::size_t equals = text.find('=', at);
    if (at == std::string_view::npos || equals == std::string_view::npos) return std::nullopt;
    const std::size_t quote = text.find_first_of("\"'", equals);
    if (quote == std::string_view::npos) return std::nullopt;
    const std::size_t end = text.find(text[quote], quote + 1);
    if (end == std::string_view::npos) return std::nullopt;
    if (trimmed(text.substr(at, equals - at)) == attribute) {
      const std::string_view value = text.substr(quote + 1, end - quote - 1);
      if (value.find('&') != std::string_view::npos) return std::nullopt;
      return std::string(value);
    }
    at = end + 1;
  }
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::optional<std::vector<double>> parseNumbers(const std::string& text, std::size_t count) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::vector<double> numbers(count);
  for (double& number : numbers) {
    if (!(in >> number) || !std::isfinite(number)) return std::nullopt;
  }
  if (!(in >> std::ws).eof()) return std::nullopt;
  return numbers;
}

std::optional<Pose> parsePose(const std::string& text) {
  const auto v = parseNumbers(text, 6);
  if (!v) return std::nullopt;
  return Pose((*v)[0], (*v)[1], (*v)[2], (*v)[3], (*v)[4], (*v)[5]);
}

}  // namespace kiva
