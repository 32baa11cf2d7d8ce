// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/parameters.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace kiva {
namespace {

constexpr const char* kBlanks = " \t\r\n";

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Returns the whole of `text` as a number; independent of the locale, unlike strtod.
template <typename Number>
std::optional<Number> parse(const std::string& text) {
  const char* const begin = text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
  const char* const end = text.data() + text.size();
  Number value{};
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

template <typename Number>
std::string range(Number lower, Number upper) {
  std::ostringstream out;
  const bool open = upper >= std::numeric_limits<Number>::max();
  if (open) {
    out << "from " << lower << " upwards";
  } else {
    out << "from " << lower << " to " << upper;
  }
  return out.str();
}

std::string prefix(const std::string& where) { return where.empty() ? "" : where + ": "; }

template <typename Number>
Number readNumber(const Parameters& parameters, const std::string& key, const std::string& text,
                  const char* what, Number lower, Number upper) {
  const auto value = parse<Number>(trimmed(text));
  // Written so that NaN, which compares with nothing, is refused too.
  if (value && *value >= lower && *value <= upper) return *value;
  throw DescriptionError(prefix(parameters.where()) + "parameter '" + key + "' is '" +
                         trimmed(text) + "', expected " + what + " " + range(lower, upper));
}

template <typename Keys>
std::string listed(const Keys& keys) {
  std::string list;
  for (const std::string& key : keys) list += (list.empty() ? "'" : ", '") + key + "'";
  return list;
}

}  // namespace

double Parameters::number(const std::string& key, double fallback, double lower,
                          double upper) const {
  const std::string* entry = find(key);
  return entry ? readNumber(*this, key, *entry, "a number", lower, upper) : fallback;
}

int Parameters::whole(const std::string& key, int fallback, int lower, int upper) const {
  const std::string* entry = find(key);
  return entry ? readNumber(*this, key, *entry, "a whole number", lower, upper) : fallback;
}

std::string Parameters::text(const std::string& key, const std::string& fallback) const {
  const std::string* entry = find(key);
  return entry ? trimmed(*entry) : fallback;
}

bool Parameters::flag(const std::string& key, bool fallback) const {
  const std::string* entry = find(key);
  if (!entry) return fallback;
  const std::string text = trimmed(*entry);
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  throw DescriptionError(prefix(where_) + "parameter '" + key + "' is '" + text +
                         "', expected true or false");
}

std::vector<double> Parameters::numbers(const std::string& key,
                                        const std::vector<double>& fallback) const {
  const std::string* entry = find(key);
  if (!entry) return fallback;
  std::vector<double> out;
  std::istringstream words(*entry);
  for (std::string word; words >> word;) {
    const auto value = parse<double>(word);
    if (value && std::isfinite(*value)) out.push_back(*value);
  }
  if (out.size() == fallback.size()) return out;
  throw DescriptionError(prefix(where_) + "parameter '" + key + "' is '" + trimmed(*entry) +
                         "', expected " + std::to_string(fallback.size()) + " numbers");
}

void Parameters::ignore(const std::string& section) const {
  for (const auto& [key, text] : values_) {
    if (key == section || key.rfind(section + "/", 0) == 0) read_.insert(key);
  }
}

std::vector<std::string> Parameters::unread() const {
  std::vector<std::string> out;
  for (const auto& [key, text] : values_) {
    if (read_.count(key) == 0 && key != "robotNamespace") out.push_back(key);
  }
  return out;
}

void Parameters::rejectUnread() const {
  const std::vector<std::string> unknown = unread();
  if (unknown.empty()) return;
  const std::string known = read_.empty() ? "it takes none" : "it takes " + listed(read_);
  throw DescriptionError(prefix(where_) + "unknown parameter " + listed(unknown) + "; " + known);
}

const std::string* Parameters::find(const std::string& key) const {
  read_.insert(key);
  const auto at = values_.find(key);
  return at == values_.end() ? nullptr : &at->second;
}

}  // namespace kiva
