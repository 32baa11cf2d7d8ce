// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_errors.h"

#include <algorithm>
#include <regex>
#include <sdf/Console.hh>

namespace kiva {
namespace {

using ErrorCode = sdf::ErrorCode;

/// What libsdformat calls the file of a document that came as text.
constexpr const char* kText = "<data-string>";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// `/sdf/model[@name="m"]/link[@name="l"]/pose` → `model 'm', link 'l', pose`.
std::string entity(const std::string& xml_path) {
  static const std::regex kSegment(R"re(/([^/\[]+)(\[@name="([^"]*)"\]|\[\d+\])?)re");
  std::string text;
  bool named = true;
  for (std::sregex_iterator it(xml_path.begin(), xml_path.end(), kSegment), end; it != end; ++it) {
    const std::smatch& match = *it;
    if (match[1] == "sdf") continue;
    const bool has_name = match[3].matched;
    if (!text.empty()) text += named || has_name ? ", " : "/";
    text += match[1].str() + (has_name ? " '" + match[3].str() + "'" : "");
    named = has_name;
  }
  return text;
}

/// One message a line, `Error [file:line] text`, in colours.
struct Printed {
  std::string errors;
  std::vector<std::string> warnings;
};

Printed sortPrinted(const std::string& printed) {
  static const std::regex kColours("\x1b\\[[0-9;]*m");
  static const std::regex kPrefix(R"(^(Error|Warning|Msg) \[[^\]]*\] ?)");
  Printed sorted;
  std::istringstream lines(std::regex_replace(printed, kColours, ""));
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    // The last one speaks of a format older than SDF, which nobody tries.
    if (!std::regex_search(line, match, kPrefix) || contains(line, "old deprecated")) continue;
    const std::string text = match.suffix();
    if (match[1] == "Warning") sorted.warnings.push_back(text);
    if (match[1] == "Error") sorted.errors += (sorted.errors.empty() ? "" : "; ") + text;
  }
  return sorted;
}

/// `Error=XML_ERROR_MISMATCHED_ELEMENT ErrorID=14 (0xe) Line number=3: XMLElement name=link` →
/// line 3, "the XML is ill-formed: mismatched element (XMLElement name=link)".
bool readXmlError(const std::string& printed, sdf::Error* error) {
  static const std::regex kError(
      R"(XML_(ERROR_)?(\w+) ErrorID=\S+ \S+ Line number=(\d+)(: (.*))?)");
  std::smatch match;
  if (!std::regex_search(printed, match, kError)) return false;
  std::string cause = match[2];
  for (char& letter : cause) letter = letter == '_' ? ' ' : static_cast<char>(std::tolower(letter));
  if (match[5].matched) cause += " (" + match[5].str() + ")";
  *error = sdf::Error(ErrorCode::STRING_READ, "the XML is ill-formed: " + cause);
  error->SetLineNumber(std::stoi(match[3]));
  return true;
}

bool isHarmless(const sdf::Error& error) {
  switch (error.Code()) {
    case ErrorCode::ATTRIBUTE_DEPRECATED:
    case ErrorCode::ELEMENT_DEPRECATED:
    case ErrorCode::VERSION_DEPRECATED:
      return true;
    default:
      return contains(error.Message(), "not defined in SDF");
  }
}

/// Says only that something below it failed.
bool isEcho(const sdf::Error& error) {
  return contains(error.Message(), "Error reading element") ||
         contains(error.Message(), "Unable to parse sdf element");
}

sdf::Error withMessage(const sdf::Error& error, const std::string& message) {
  sdf::Error renamed(error.Code(), message);
  if (error.FilePath()) renamed.SetFilePath(*error.FilePath());
  if (error.LineNumber()) renamed.SetLineNumber(*error.LineNumber());
  if (error.XmlPath()) renamed.SetXmlPath(*error.XmlPath());
  return renamed;
}

/// What the user can use of libsdformat's wording.
std::string plain(std::string message) {
  static const std::regex kCopying(R"(\. Copying\[.*)");
  static const std::regex kPrelude(R"(^(Unknown error|Invalid argument)\. )");
  message = std::regex_replace(message, kCopying, "");
  message = std::regex_replace(message, kPrelude, "");
  message.erase(message.find_last_not_of(" \n") + 1);
  return message;
}

}  // namespace

sdf::Error noteAt(const sdf::ElementConstPtr& element, const std::string& message) {
  sdf::Error error(ErrorCode::ELEMENT_INVALID, message);
  if (!element) return error;
  error.SetXmlPath(element->XmlPath());
  if (!element->FilePath().empty()) error.SetFilePath(element->FilePath());
  if (element->LineNumber()) error.SetLineNumber(*element->LineNumber());
  return error;
}

void failAt(const sdf::ElementConstPtr& element, const std::string& message) {
  throw SdfError(noteAt(element, message));
}

std::string describe(const sdf::Error& error, const std::string& where) {
  const std::string file = error.FilePath().value_or(kText);
  std::string text = file == kText || file.empty() ? where : file;
  if (error.LineNumber()) text += ":" + std::to_string(*error.LineNumber());
  const std::string what = entity(error.XmlPath().value_or(""));
  return text + ": " + (what.empty() ? "" : what + ": ") + plain(error.Message());
}

void throwErrors(const sdf::Errors& errors, const std::string& printed, sdf::Errors* warnings) {
  const Printed sorted = sortPrinted(printed);
  sdf::Error xml_error;
  if (readXmlError(sorted.errors, &xml_error)) throw SdfError(xml_error);
  for (const sdf::Error& error : errors) {
    if (isHarmless(error)) {
      warnings->push_back(error);
    } else if (isEcho(error) && !sorted.errors.empty()) {
      throw SdfError(withMessage(error, sorted.errors));
    } else {
      throw SdfError(error);
    }
  }
  if (!sorted.errors.empty()) throw SdfError(sdf::Error(ErrorCode::STRING_READ, sorted.errors));
  for (const std::string& text : sorted.warnings) warnings->emplace_back(ErrorCode::NONE, text);
}

std::mutex ConsoleCapture::mutex_;

ConsoleCapture::ConsoleCapture() : lock_(mutex_) {
  auto& stream = sdf::Console::Instance()->GetMsgStream();
  before_ = stream.GetStream();
  stream.SetStream(&printed_);
}

ConsoleCapture::~ConsoleCapture() { sdf::Console::Instance()->GetMsgStream().SetStream(before_); }

}  // namespace kiva
