// SPDX-License-Identifier: Apache-2.0
#include "world_file/errors.h"

#include <algorithm>
#include <regex>
#include <sdf/Console.hh>

#include "world_file/format.h"

namespace kiva {
namespace {

using ErrorCode = sdf::ErrorCode;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// `/sdf/model[@name="m"]/link[@name="l"]/pose` → `model 'm', link 'l', pose`.
std::string entity(const std::string& xml_path) {
  std::string text;
  bool named = true;
  for (const PathStep& step : pathSteps(xml_path)) {
    if (step.element == "sdf") continue;
    if (!text.empty()) text += named || step.name ? ", " : "/";
    text += step.element + (step.name ? " '" + *step.name + "'" : "");
    named = step.name.has_value();
  }
  return text;
}

/// libsdformat quotes what it can't read, be it a whole document; and std::regex overflows the
/// stack on what is too long.
std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  return text.size() > kLongest ? text.substr(0, kLongest) + "…" : text;
}

/// One message a line, `Error [file:line] text`, in colours.
struct Printed {
  std::string errors;
  std::vector<std::string> warnings;
};

Printed sortPrinted(const std::string& printed) {
  static const std::regex kPrefix(
      "^(\x1b\\[[0-9;]*m)?(Error|Warning) \\[[^\\]]*\\](\x1b\\[[0-9;]*m)? ?");
  Printed sorted;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    line = shortened(line);
    std::smatch match;
    // The last one is about a format older than SDF, which is not tried.
    if (!std::regex_search(line, match, kPrefix) || contains(line, "old deprecated")) continue;
    const std::string text = match.suffix();
    if (match[2] == "Warning") sorted.warnings.push_back(text);
    if (match[2] == "Error" && !contains(sorted.errors, text)) {
      sorted.errors += (sorted.errors.empty() ? "" : "; ") + text;
    }
  }
  sorted.errors = shortened(sorted.errors);
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
  if (cause.compare(0, 7, "parsing") == 0) cause = "error while " + cause;
  if (match[5].matched) cause += " (" + match[5].str() + ")";
  *error = sdf::Error(ErrorCode::STRING_READ, "the XML is ill-formed: " + cause);
  error->SetLineNumber(std::stoi(match[3]));
  return true;
}

/// `[/sdf/model[@name="m"]/odd:file:L7]: text`, as libsdformat prints its warnings.
sdf::Error readWarning(const std::string& printed) {
  static const std::regex kLocated(R"(^\[(/.*):([^:]*):L(\d+)\]: (.*))");
  std::smatch match;
  if (!std::regex_search(printed, match, kLocated)) return {ErrorCode::NONE, printed};
  sdf::Error warning(ErrorCode::NONE, match[4], match[2], std::stoi(match[3]));
  warning.SetXmlPath(match[1]);
  return warning;
}

/// Says only that something below it failed.
bool isEcho(const sdf::Error& error) {
  return contains(error.Message(), "Error reading element") ||
         contains(error.Message(), "Unable to parse sdf element");
}

/// Returns the part of libsdformat's wording that helps the user.
std::string plain(std::string message) {
  static const std::regex kTail(R"(\. (Copying\[|Using the first).*)");
  static const std::regex kValue(R"(.*Unable to set value \[(.*?) ?\] ?for key ?\[(.*)\])");
  static const std::regex kVersion(R"(Unable to convert from SDF version (\S+) to (\S+))");
  message = std::regex_replace(shortened(message), kTail, "");
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
  return reworded(error, cause);
}

}  // namespace

std::string causeOf(const sdf::Error& error) { return plain(error.Message()); }

sdf::Error xmlError(const std::string& printed) {
  sdf::Error error(ErrorCode::STRING_READ, "the XML is ill-formed: " + printed);
  readXmlError(printed, &error);
  return error;
}

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

sdf::Error reworded(const sdf::Error& error, const std::string& message) {
  sdf::Error renamed(error.Code(), message);
  if (error.FilePath()) renamed.SetFilePath(*error.FilePath());
  if (error.LineNumber()) renamed.SetLineNumber(*error.LineNumber());
  if (error.XmlPath()) renamed.SetXmlPath(*error.XmlPath());
  return renamed;
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
  if (!errors.empty()) {
    const sdf::Error& first = errors.front();
    throw SdfError(isEcho(first) && !sorted.errors.empty() ? withCause(first, sorted.errors)
                                                           : first);
  }
  if (!sorted.errors.empty()) throw SdfError(sdf::Error(ErrorCode::STRING_READ, sorted.errors));
  for (const std::string& text : sorted.warnings) warnings->push_back(readWarning(text));
}

std::mutex ConsoleCapture::mutex_;

ConsoleCapture::ConsoleCapture() : lock_(mutex_) {
  auto& stream = sdf::Console::Instance()->GetMsgStream();
  before_ = stream.GetStream();
  stream.SetStream(&printed_);
}

ConsoleCapture::~ConsoleCapture() { sdf::Console::Instance()->GetMsgStream().SetStream(before_); }

std::string ConsoleCapture::take() {
  std::string text = printed_.str();
  printed_.str("");
  return text;
}

}  // namespace kiva
