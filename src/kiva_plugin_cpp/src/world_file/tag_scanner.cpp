// SPDX-License-Identifier: Apache-2.0
#include "world_file/tag_scanner.h"

#include <algorithm>

namespace kiva {

bool TagScanner::next() {
  for (;;) {
    begin = xml_.find('<', end);
    if (begin == std::string_view::npos) return false;
    if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>")) continue;
    return readTag();
  }
}

bool TagScanner::skip(std::string_view opening, std::string_view closing) {
  if (xml_.compare(begin, opening.size(), opening) != 0) return false;
  const std::size_t found = xml_.find(closing, begin + opening.size());
  end = found == std::string_view::npos ? xml_.size() : found + closing.size();
  return true;
}

bool TagScanner::readTag() {
  const std::size_t bracket = closingBracket();
  if (bracket == std::string_view::npos) return false;
  end = bracket + 1;
  std::string_view inside = xml_.substr(begin + 1, bracket - begin - 1);
  if (inside.empty() || inside[0] == '!') return false;  // A DOCTYPE may define entities.
  opens = inside.front() != '/';
  if (!opens) inside.remove_prefix(1);
  closes = !opens || (!inside.empty() && inside.back() == '/');
  if (opens && closes) inside.remove_suffix(1);
  const std::size_t length = std::min(inside.find_first_of(" \t\r\n"), inside.size());
  name = inside.substr(0, length);
  attributes = inside.substr(length);
  return !name.empty();
}

/// The `>` that ends the tag; one in quotes does not.
std::size_t TagScanner::closingBracket() const {
  char quote = 0;
  for (std::size_t i = begin; i < xml_.size(); ++i) {
    const char letter = xml_[i];
    if (quote != 0) {
      if (letter == quote) quote = 0;
    } else if (letter == '"' || letter == '\'') {
      quote = letter;
    } else if (letter == '>') {
      return i;
    }
  }
  return std::string_view::npos;
}

}  // namespace kiva
