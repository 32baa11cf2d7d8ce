// SPDX-License-Identifier: Apache-2.0
//
// Constants that the parts of Execution share.
#pragma once

namespace fleet {

constexpr double kCentred = 0.02;                // largest distance from a grid point [m]
constexpr double kStandstill = 0.01;             // largest speed [m/s]
constexpr double kAligned = 0.05;                // largest angle to the way ahead [rad]
constexpr double kQuarter = 1.5707963267948966;  // quarter turn [rad]
constexpr double kUnanswered = 0.5;              // wait before a message is sent again [s]

}  // namespace fleet
