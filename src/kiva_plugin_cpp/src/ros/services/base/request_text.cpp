// SPDX-License-Identifier: Apache-2.0
#include "ros/services/base/request_text.h"

#include <cstdio>
#include <regex>

namespace kiva_ros {
namespace {

constexpr std::size_t kMostText = 200;  // bytes of a text; models are large

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Returns the first bytes of a text, and not half a character.
std::string cut(const std::string& text) {
  if (text.size() <= kMostText) return text;
  std::size_t end = kMostText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "… (" + std::to_string(text.size()) + " bytes)";
}

/// Returns a text as YAML's double quotes have it.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02X", static_cast<unsigned char>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

RequestText& RequestText::operator<<(const char* literal) {
  is_value_ = endsWith(literal, ": ");
  out_ << literal;
  return *this;
}

RequestText& RequestText::operator<<(const std::string& text) {
  out_ << (is_value_ ? quoted(cut(text)) : text);
  is_value_ = false;
  return *this;
}

RequestText& RequestText::operator<<(std::ostream& (*end)(std::ostream&)) {
  is_value_ = false;
  out_ << end;
  return *this;
}

std::string RequestText::yaml() const {
  // The printer writes `name[]` over lines `  name[0]: value`.
  static const std::regex kArray(R"((^|\n)( *\w+)\[\](?=\n))"),
      kElement(R"((^|\n)( *)\w+\[\d+\]:)");
  const std::string lists = std::regex_replace(out_.str(), kElement, "$1$2-");
  return std::regex_replace(lists, kArray, "$1$2:");
}

}  // namespace kiva_ros
