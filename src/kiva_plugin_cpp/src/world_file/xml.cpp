// SPDX-License-Identifier: Apache-2.0
#include "world_file/xml.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "world_file/errors.h"
#include "world_file/format.h"

namespace kiva {
namespace {

/// tinyxml2's printer forgets where things were.
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
  int line_ = 1;             // of the output's end
  std::size_t counted_ = 0;  // Up to here lines are counted.
};

/// Text on one line, as it is compared.
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

/// As libsdformat has it.
std::string pathOf(const XmlElement& element) {
  std::string path = std::string("/") + element.Name();
  const char* const name = element.Attribute("name");
  if (name) path += "[@name=\"" + std::string(name) + "\"]";
  const tinyxml2::XMLNode* const parent = element.Parent();
  return parent && parent->ToElement() ? pathOf(*parent->ToElement()) + path : path;
}

XmlElement* find(XmlElement* element, const std::vector<PathStep>& steps, std::size_t depth,
                 int line) {
  const PathStep& step = steps[depth];
  const char* const name = element->Attribute("name");
  if (step.element != element->Name()) return nullptr;
  if (step.name && (!name || *step.name != name)) return nullptr;
  if (depth + 1 == steps.size()) {
    return line <= 0 || element->GetLineNum() == line ? element : nullptr;
  }
  for (XmlElement* child = element->FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    if (XmlElement* found = find(child, steps, depth + 1, line)) return found;
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<XmlDocument> parseXml(const std::string& text) {
  if (text.size() > kMostBytes) {
    throw SdfError(sdf::Error(sdf::ErrorCode::STRING_READ,
                              "it has " + std::to_string(text.size()) + " bytes; expected " +
                                  std::to_string(kMostBytes) + " at the most"));
  }
  auto document = std::make_unique<XmlDocument>();
  if (document->Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS) return document;
  if (document->ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    sdf::Error error(sdf::ErrorCode::STRING_READ,
                     "elements nest deeper than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH));
    error.SetLineNumber(document->ErrorLineNum());
    throw SdfError(error);
  }
  throw SdfError(xmlError(document->ErrorStr()));
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

sdf::Error noteAt(const XmlElement& element, const std::string& message) {
  sdf::Error note(sdf::ErrorCode::ELEMENT_INVALID, message);
  note.SetXmlPath(pathOf(element));
  note.SetLineNumber(element.GetLineNum());
  return note;
}

XmlElement* findElement(XmlDocument& document, const std::string& xml_path, int line) {
  const std::vector<PathStep> steps = pathSteps(xml_path);
  XmlElement* const root = document.RootElement();
  return root && !steps.empty() ? find(root, steps, 0, line) : nullptr;
}

std::string attributeOf(const XmlElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value ? trimmed(value) : "";
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
  constexpr const char* kBlanks = " \t\r\n";
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
