// SPDX-License-Identifier: Apache-2.0
#include "world_file/files/xml.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "world_file/files/errors.h"

namespace kiva {
namespace {

constexpr char kBlanks[] = " \t\r\n";

/// Prints elements on their original lines, which tinyxml2's printer does not.
class LinePrinter : public tinyxml2::XMLPrinter {
 public:
  LinePrinter() : XMLPrinter(nullptr, true) {}

  bool VisitEnter(const XmlElement& element, const tinyxml2::XMLAttribute* first) override {
    const char* const end = CStr() + CStrSize() - 1;
    line_ += static_cast<int>(std::count(CStr() + counted_, end, '\n'));
    counted_ = CStrSize() - 1;
    if (element.GetLineNum() > line_) {
      const auto missing = static_cast<std::size_t>(element.GetLineNum() - line_);
      Write(std::string(missing, '\n').c_str());
    }
    return XMLPrinter::VisitEnter(element, first);
  }
  bool Visit(const tinyxml2::XMLComment&) override { return true; }

 private:
  int line_ = 1;             // at the end of the output
  std::size_t counted_ = 0;  // length of the output whose lines are counted
};

/// Prints on one line, for comparisons.
class FlatPrinter : public tinyxml2::XMLPrinter {
 public:
  explicit FlatPrinter(const XmlElement* but) : XMLPrinter(nullptr, true), but_(but) {}
  bool VisitEnter(const XmlElement& element, const tinyxml2::XMLAttribute* first) override {
    if (&element == but_) return false;
    return XMLPrinter::VisitEnter(element, first);
  }
  bool VisitExit(const XmlElement& element) override {
    return &element == but_ || XMLPrinter::VisitExit(element);
  }
  bool Visit(const tinyxml2::XMLText& text) override {
    std::string flat = text.Value();
    std::replace(flat.begin(), flat.end(), '\n', ' ');
    PushText(flat.c_str(), text.CData());
    return true;
  }
  bool Visit(const tinyxml2::XMLComment&) override { return true; }

 private:
  const XmlElement* but_;
};

/// Returns whether the element is a frame that poses may refer to.
bool isFrame(const XmlElement& element) {
  return is(element, "link") || is(element, "joint") || is(element, "frame") ||
         is(element, "model");
}

const XmlElement* elementAround(const XmlElement& element) {
  const tinyxml2::XMLNode* const parent = element.Parent();
  return parent ? parent->ToElement() : nullptr;
}

/// Returns whether an element comes from another file than the one around it, so that its address
/// begins here.
bool beginsFile(const XmlElement& element, const XmlElement& around) {
  const Source* const own = sourceOf(element);
  const Source* const other = sourceOf(around);
  return own && !own->file.empty() && (!other || own->file != other->file);
}

/// Returns `model 'm', link 'l', inertial/mass`.
std::string entityOf(const XmlElement& element) {
  const std::string kind = element.Name();
  if (kind == "sdf") return "";
  const char* const name = element.Attribute("name");
  const std::string own = kind + (name ? " '" + std::string(name) + "'" : "");
  const XmlElement* const around = elementAround(element);
  if (!around || beginsFile(element, *around)) return own;
  const std::string before = entityOf(*around);
  if (before.empty()) return own;
  return before + (around->Attribute("name") || name ? ", " : "/") + own;
}

/// Rewords `Error=XML_ERROR_MISMATCHED_ELEMENT ErrorID=14 (0xe) Line number=3: XMLElement
/// name=link` as "the XML is ill-formed: mismatched element (XMLElement name=link)".
Fault faultOfXml(const XmlDocument& document) {
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    return {"elements nest deeper than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH), "", "",
            document.ErrorLineNum()};
  }
  std::string cause = document.ErrorName();
  for (const char* prefix : {"XML_ERROR_", "XML_"}) {
    if (startsWith(cause, prefix)) cause.erase(0, std::strlen(prefix));
  }
  for (char& letter : cause) letter = letter == '_' ? ' ' : static_cast<char>(std::tolower(letter));
  if (startsWith(cause, "parsing")) cause = "error while " + cause;
  const std::string message = document.ErrorStr();
  const std::size_t detail = message.find(": ", message.find("Line number="));
  if (detail != std::string::npos) cause += " (" + message.substr(detail + 2) + ")";
  return {"the XML is ill-formed: " + cause, "", "", document.ErrorLineNum()};
}

}  // namespace

const XmlElement* XmlDocument::findFrame(const XmlElement& scope, const std::string& name) {
  const auto& document = static_cast<const XmlDocument&>(*scope.GetDocument());
  if (!document.is_final_) {
    for (auto part = scope.FirstChildElement(); part; part = part->NextSiblingElement()) {
      if (hasName(*part, name) && isFrame(*part)) return part;
    }
    return nullptr;
  }
  const auto [frames, is_new] = document.frames_.try_emplace(&scope);
  if (is_new) {
    for (auto part = scope.FirstChildElement(); part; part = part->NextSiblingElement()) {
      if (isFrame(*part)) frames->second.emplace(attributeOf(*part, "name"), part);
    }
  }
  const auto frame = frames->second.find(name);
  return frame == frames->second.end() ? nullptr : frame->second;
}

std::unique_ptr<XmlDocument> parseXml(const std::string& text) {
  if (text.size() > kMostBytes) {
    throw SdfError({"it has " + std::to_string(text.size()) + " bytes; expected at most " +
                        std::to_string(kMostBytes),
                    "", "", 0});
  }
  auto document = std::make_unique<XmlDocument>();
  if (document->Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS) return document;
  throw SdfError(faultOfXml(*document));
}

std::string textOf(const XmlDocument& document) {
  LinePrinter printer;
  document.Accept(&printer);
  return {printer.CStr(), static_cast<std::size_t>(printer.CStrSize()) - 1};
}

std::string textOf(const XmlElement& element, const XmlElement* but) {
  FlatPrinter printer(but);
  element.Accept(&printer);
  return {printer.CStr(), static_cast<std::size_t>(printer.CStrSize()) - 1};
}

const Source* sourceOf(const XmlElement& element) {
  return static_cast<const Source*>(element.GetUserData());
}

Fault noteAt(const XmlElement& element, const std::string& message) {
  const Source* const source = sourceOf(element);
  return {message, entityOf(element), source ? source->file : "",
          source ? source->line : element.GetLineNum()};
}

void failAt(const XmlElement& element, const std::string& message) {
  throw SdfError(noteAt(element, message));
}

bool is(const XmlElement& element, const char* name) {
  return std::strcmp(element.Name(), name) == 0;
}

std::string attributeOf(const XmlElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value ? trimmed(value) : "";
}

bool hasName(const XmlElement& element, const std::string& name) {
  const char* begin = element.Attribute("name");
  if (!begin) return name.empty();
  begin += std::strspn(begin, kBlanks);
  const char* end = begin + std::strlen(begin);
  while (end > begin && std::strchr(kBlanks, end[-1])) --end;
  return name.compare(0, std::string::npos, begin, static_cast<std::size_t>(end - begin)) == 0;
}

std::string contentOf(const XmlElement* element) {
  std::string content;
  if (!element) return content;
  for (const tinyxml2::XMLNode* part = element->FirstChild(); part; part = part->NextSibling()) {
    if (part->ToText()) content += part->Value();
  }
  return trimmed(content);
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
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

std::string textOf(const Pose& pose) {
  std::ostringstream out;
  out.precision(17);
  out << pose.X() << ' ' << pose.Y() << ' ' << pose.Z() << ' ' << pose.Roll() << ' ' << pose.Pitch()
      << ' ' << pose.Yaw();
  return out.str();
}

}  // namespace kiva
