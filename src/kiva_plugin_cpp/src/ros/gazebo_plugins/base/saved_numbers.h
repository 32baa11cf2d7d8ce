// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kiva_ros {

/// Returns numbers as text that keeps every bit, for checkpoints.
std::string toText(const std::vector<double>& numbers);
/// Returns `count` numbers of a text, NaN where it has none: the text is not trusted.
std::vector<double> fromText(const std::string& text, std::size_t count);
/// Returns a number clamped to ±`most`; 0 if it is not finite.
double bounded(double number, double most);

}  // namespace kiva_ros
