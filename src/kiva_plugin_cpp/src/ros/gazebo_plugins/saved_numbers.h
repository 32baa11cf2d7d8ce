// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kiva_ros {

/// Numbers as text that a checkpoint keeps to the last bit.
std::string toText(const std::vector<double>& numbers);
/// As many as that, NaN where the text has none: it may come from anywhere.
std::vector<double> fromText(const std::string& text, std::size_t count);
/// The number within ±`most`; 0 where it is not finite.
double bounded(double number, double most);

}  // namespace kiva_ros
