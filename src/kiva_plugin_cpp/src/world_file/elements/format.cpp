// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/format.h"

#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <sstream>

namespace kiva {
namespace {

/// Reads the table; its elements live as long as the program.
class FormatTable {
 public:
  explicit FormatTable(const char* at) : at_(at) {
    while (skipBlanks(), *at_ == '#') {
      ++at_;
      const std::string line = word();
      skipBlanks();
      lines_[line] = element({});
    }
  }
  const ElementFormat& root() { return *lines_.at("root").format; }

 private:
  using Child = ElementFormat::Child;

  void skipBlanks() {
    while (*at_ == ' ' || *at_ == '\n') ++at_;
  }
  std::string word() {
    const char* const begin = at_;
    while (*at_ && (std::isalnum(static_cast<unsigned char>(*at_)) || *at_ == '_')) ++at_;
    return {begin, at_};
  }
  std::string text() {
    const bool is_quoted = *at_ == '\'';
    if (is_quoted) ++at_;
    const char* const begin = at_;
    const char* const stops = is_quoted ? "'" : " \n)<>";
    at_ += std::strcspn(at_, stops);
    std::string word(begin, at_);
    for (char& letter : word) letter = letter == '\n' ? ' ' : letter;
    if (is_quoted) ++at_;
    return word;
  }
  ValueFormat value() {
    ValueFormat format;
    format.type = *at_++;
    ++at_;  // =
    format.otherwise = text();
    for (auto* limit : {&format.least, &format.most}) {
      if (*at_ != (limit == &format.least ? '<' : '>')) continue;
      char* end;
      *limit = std::strtod(at_ + 1, &end);
      at_ = end;
      while (*at_ && !std::strchr(" \n)>", *at_)) ++at_;
    }
    return format;
  }

  Child element(std::vector<const ElementFormat*> around) {
    elements_.emplace_back();
    ElementFormat& element = elements_.back();
    element.name = word();
    Child child{&element, *at_++};
    if (*at_ == ':') {
      ++at_;
      element.value = value();
    }
    around.push_back(&element);
    for (skipBlanks(); *at_ == '@' || *at_ == '~' || *at_ == '('; skipBlanks()) {
      const char kind = *at_++;
      if (kind == '~') element.is_open = true;
      if (kind == '@') attribute(&element);
      if (kind == '(') children(&element, around);
    }
    return child;
  }
  void attribute(ElementFormat* of) {
    AttributeFormat attribute;
    attribute.name = word();
    attribute.is_required = *at_++ == '!';
    attribute.value = value();
    of->attributes.push_back(attribute);
  }
  void children(ElementFormat* of, const std::vector<const ElementFormat*>& around) {
    while (skipBlanks(), *at_ != ')') {
      const bool is_line = *at_ == '&', is_around = *at_ == '^';
      if (!is_line && !is_around) {
        of->children.push_back(element(around));
        continue;
      }
      ++at_;
      const std::string name = word();
      Child child = is_line ? lines_.at(name) : Child{around.front(), '*'};
      if (*at_ && std::strchr("!?+*x", *at_)) child.count = *at_++;
      of->children.push_back(child);
    }
    ++at_;
  }

  const char* at_;
  std::deque<ElementFormat> elements_;
  std::map<std::string, Child> lines_;
};

}  // namespace

const ElementFormat::Child* ElementFormat::child(const std::string& of_name) const {
  for (const Child& child : children) {
    if (child.format->name == of_name) return &child;
  }
  return nullptr;
}

const ElementFormat& sdfFormat() {
  // The line of <sdf> is the last of the table: each line refers only to those before it.
  static FormatTable table(kFormatText);
  return table.root();
}

std::string wordsFor(char type) {
  static const std::map<char, std::string> kWords = {{'d', "a number"},
                                                     {'i', "a whole number"},
                                                     {'u', "a whole number of 0 or above"},
                                                     {'b', "true or false"},
                                                     {'2', "two numbers"},
                                                     {'3', "three numbers"},
                                                     {'c', "red green blue alpha"},
                                                     {'p', "six numbers, x y z roll pitch yaw"}};
  const auto entry = kWords.find(type);
  return entry == kWords.end() ? "" : entry->second;
}

std::string defaultText(const ValueFormat& format) {
  if (!std::strchr("d23c", format.type))
    return format.type == 'b' ? (format.otherwise == "true" ? "1" : "0") : format.otherwise;
  std::istringstream in(format.otherwise);
  std::ostringstream out;
  out.precision(17);
  bool is_first = true;
  for (double number; in >> number; is_first = false) out << (is_first ? "" : " ") << number;
  return out.str();
}

}  // namespace kiva
