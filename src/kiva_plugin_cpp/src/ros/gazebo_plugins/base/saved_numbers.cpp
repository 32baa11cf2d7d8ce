// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/base/saved_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace kiva_ros {

std::string toText(const std::vector<double>& numbers) {
  std::ostringstream out;
  out << std::hexfloat;
  for (double number : numbers) out << number << ' ';
  return out.str();
}

std::vector<double> fromText(const std::string& text, std::size_t count) {
  std::istringstream words(text);
  std::vector<double> out;
  // Streams can't read hexadecimal floats.
  for (std::string word; words >> word;) out.push_back(std::strtod(word.c_str(), nullptr));
  out.resize(count, std::numeric_limits<double>::quiet_NaN());
  return out;
}

double bounded(double number, double most) {
  return std::isfinite(number) ? std::clamp(number, -most, most) : 0;
}

}  // namespace kiva_ros
