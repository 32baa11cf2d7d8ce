// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_errors.h"

#include <algorithm>
#include <regex>
#include <sdf/Console.hh>

#include "core/sdf_format.h"

namespace kiva {
namespace {

using ErrorCode = sdf::ErrorCode;

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

/// What the user can use of libsdformat's wording.
std::string plain(std::string message) {
  static const std::regex kTail(R"(\. (Copying\[|Using the first).*)");
  static const std::regex kValue(R"(.*Unable to set value \[(.*?) ?\] ?for key ?\[(.*)\])");
  static const std::regex kVersion(R"(Unable to convert from SDF version (\S+) to (\S+))");
  message = std::regex_replace(message, kTail, "");
  message = std::regex_replace(message, kVersion, "SDF version $1 is unknown; expected 1.0 to $2");
  message = std::regex_replace(message, kValue, "'$1' is no value for <$2>");
  message.erase(message.find_last_not_of(" .\n") + 1);
  return message;
}

/// `error` with the cause that was only printed, and what would have been right in its place.
sdf::Error withCause(const sdf::Error& error, const std::string& printed) {
  std::string cause = plain(printed);
  const bool is_wrong_type = contains(cause, "no value for") || contains(cause, "boolean");
  const std::string expected = expectedValue(error.XmlPath().value_or(""));
  if (is_wrong_type && !expected.empty()) cause += "; expected " + expected;
  sdf::Error renamed(error.Code(), cause);
  if (error.FilePath()) renamed.SetFilePath(*error.FilePath());
  if (error.LineNumber()) renamed.SetLineNumber(*error.LineNumber());
  if (error.XmlPath()) renamed.SetXmlPath(*error.XmlPath());
  return renamed;
}

}  // namespace

sdf::Error noteAt(const sdf::ElementConstPtr& element, const std::string& message) {
  sdf::Error error(ErrorCode::ELEMENT_INVALID, message);
  sdf::ElementConstPtr known = element;
  // What libsdformat added by itself has no place in the text.
  while (known && known->XmlPath().empty()) known = known->GetParent();
  if (!known) return error;
  error.SetXmlPath(known->XmlPath());
  if (!known->FilePath().empty()) error.SetFilePath(known->FilePath());
  if (known->LineNumber()) error.SetLineNumber(*known->LineNumber());
  return error;
}

void failAt(const sdf::ElementConstPtr& element, const std::string& message) {
  throw SdfError(noteAt(element, message));
}

std::string address(const sdf::Error& error, const std::string& where) {
  std::string text = error.FilePath().value_or("");
  // libsdformat's names for a document that came as text: <data-string>, <urdf-string>.
  if (text.empty() || text[0] == '<') text = where;
  const int line = error.LineNumber().value_or(0);
  if (line > 0 && !text.empty()) text += ":" + std::to_string(line);
  const std::string what = entity(error.XmlPath().value_or(""));
  return text + (text.empty() || what.empty() ? "" : ": ") + what;
}

std::string describe(const sdf::Error& error, const std::string& where) {
  return address(error, where) + ": " + plain(error.Message());
}

void throwErrors(const sdf::Errors& errors, const std::string& printed, sdf::Errors* warnings) {
  const Printed sorted = sortPrinted(printed);
  sdf::Error xml_error;
  if (readXmlError(sorted.errors, &xml_error)) throw SdfError(xml_error);
  for (const sdf::Error& error : errors) {
    if (isHarmless(error)) {
      warnings->push_back(error);
    } else if (isEcho(error) && !sorted.errors.empty()) {
      throw SdfError(withCause(error, sorted.errors));
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
