// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kiva {

extern const char* const kFormatText;

/// A text that SDF has in an element or an attribute.
struct ValueFormat {
  char type = 's';
  std::string otherwise;  ///< What it is if it is not given.
  std::optional<double> least, most;
};

struct AttributeFormat {
  std::string name;
  bool is_required = false;
  ValueFormat value;
};

/// What SDF allows in an element.
struct ElementFormat {
  struct Child {
    const ElementFormat* format = nullptr;
    char count = '?';  ///< ! ? + *
    bool isRequired() const { return count == '!' || count == '+'; }
  };

  std::string name;
  std::optional<ValueFormat> value;
  std::vector<AttributeFormat> attributes;
  std::vector<Child> children;
  bool is_open = false;  ///< Anything may be inside.

  const Child* child(const std::string& of_name) const;
};

/// `<sdf>` of version 1.9.
const ElementFormat& sdfFormat();

/// What a value of that type looks like, for a person: "a number"; empty for text.
std::string wordsFor(char type);

/// A default as a text: numbers with all their digits.
std::string defaultText(const ValueFormat& format);

}  // namespace kiva
