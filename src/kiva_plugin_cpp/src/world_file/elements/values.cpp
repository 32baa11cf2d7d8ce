// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/values.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace kiva {
namespace {

/// Returns the numbers at the beginning of a text and ignores what follows them.
std::vector<double> numbersOf(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number; in >> number;) numbers.push_back(number);
  return numbers;
}

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

bool isWhole(const std::string& text, bool is_unsigned) {
  char* end = nullptr;
  errno = 0;
  if (is_unsigned) {
    std::strtoull(text.c_str(), &end, 0);
  } else {
    std::strtol(text.c_str(), &end, 0);
  }
  return end != text.c_str() && errno == 0;
}

std::string shortest(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

std::string faultOfRange(double value, const std::string& text, const std::string& name,
                         const ValueFormat& format) {
  if (format.least && value < *format.least) {
    return "The value [" + text + "] is less than the minimum allowed value of [" +
           shortest(*format.least) + "] for key [" + name + "]";
  }
  if (format.most && value > *format.most) {
    return "The value [" + text + "] is greater than the maximum allowed value of [" +
           shortest(*format.most) + "] for key [" + name + "]";
  }
  return "";
}

bool isValue(const std::string& text, char type) {
  switch (type) {
    case 'd':
      return readDouble(text).has_value();
    case 'i':
    case 'u':
      return isWhole(text, type == 'u');
    case '2':
    case 't':
      return numbersOf(text).size() >= 2;
    case '3':
      return numbersOf(text).size() >= 3;
    case 'c':
      return readColour(text).has_value();
    default:
      return true;
  }
}

}  // namespace

std::optional<double> readDouble(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return std::nullopt;
  return value;
}

std::optional<bool> readFlag(const std::string& text) {
  std::string lower = text;
  for (char& letter : lower) letter = static_cast<char>(std::tolower(letter));
  if (lower == "true" || lower == "1") return true;
  if (lower == "false" || lower == "0") return false;
  return std::nullopt;
}

std::optional<Vector3> readVector(const std::string& text) {
  const auto numbers = numbersOf(text);
  if (numbers.size() < 3) return std::nullopt;
  return Vector3(numbers[0], numbers[1], numbers[2]);
}

std::optional<std::vector<double>> readColour(const std::string& text) {
  auto numbers = numbersOf(text);
  if (numbers.size() == 3) numbers.push_back(1);
  if (numbers.size() != 4 || wordsOf(text).size() > 4) return std::nullopt;
  for (double& number : numbers) number = static_cast<float>(number);
  return numbers;
}

std::string faultOfValue(const std::string& text, const std::string& name,
                         const ValueFormat& format) {
  if (format.type == 's') return "";
  if (format.type == 'b' && !readFlag(text)) return "Invalid boolean value; expected true or false";
  if (!isValue(text, format.type)) {
    return "'" + text + "' is not a value for <" + name + ">; expected " + wordsFor(format.type);
  }
  return format.type == 'd' ? faultOfRange(*readDouble(text), text, name, format) : "";
}

std::string faultOfPoseText(const XmlElement& pose) {
  const std::string text = contentOf(&pose);
  if (text.empty()) return "";
  const std::string form = attributeOf(pose, "rotation_format");
  const bool is_quaternion = form == "quat_xyzw";
  if (!form.empty() && !is_quaternion && form != "euler_rpy") {
    return "Undefined attribute //pose[@rotation_format='" + form +
           "'], only 'euler_rpy' and 'quat_xyzw' is supported";
  }
  const std::size_t count = is_quaternion ? 7 : 6;
  const auto words = wordsOf(text);
  for (const std::string& word : words) {
    const auto number = readDouble(word);
    if (!number) return "'" + text + "' is not a value for <pose>; expected " + wordsFor('p');
    if (!std::isfinite(*number)) return "Pose values must be finite";
  }
  if (words.size() == count) return "";
  return "The value for //pose[@rotation_format='" +
         std::string(is_quaternion ? "quat_xyzw" : "euler_rpy") + "'] must have " +
         std::to_string(count) + " values, but " + std::to_string(words.size()) +
         " were found instead in '" + text + "'";
}

double numberIn(const XmlElement& element, const char* child, double otherwise) {
  const XmlElement* const child_element = element.FirstChildElement(child);
  return child_element ? readDouble(contentOf(child_element)).value_or(otherwise) : otherwise;
}

bool flagIn(const XmlElement& element, const char* child, bool otherwise) {
  const XmlElement* const child_element = element.FirstChildElement(child);
  return child_element ? readFlag(contentOf(child_element)).value_or(otherwise) : otherwise;
}

Vector3 vectorIn(const XmlElement& element, const char* child, const Vector3& otherwise) {
  const XmlElement* const child_element = element.FirstChildElement(child);
  return child_element ? readVector(contentOf(child_element)).value_or(otherwise) : otherwise;
}

Vector3 vectorIn(const XmlElement& element) {
  return readVector(contentOf(&element)).value_or(Vector3::Zero);
}

Pose valueOfPose(const XmlElement* pose) {
  const auto v = pose ? numbersOf(contentOf(pose)) : std::vector<double>();
  if (v.size() == 7) {
    const Quaternion turn(v[6], v[3], v[4], v[5]);
    return Pose({v[0], v[1], v[2]}, turn.Normalized());
  }
  if (v.size() != 6) return Pose::Zero;
  const double unit = readFlag(attributeOf(*pose, "degrees")).value_or(false) ? M_PI / 180 : 1;
  return Pose(v[0], v[1], v[2], v[3] * unit, v[4] * unit, v[5] * unit);
}

}  // namespace kiva
