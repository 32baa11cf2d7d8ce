// SPDX-License-Identifier: Apache-2.0
//
// Numbers and distances that the parts of Execution share.
#pragma once

namespace fleet {

constexpr double kCentred = 0.02;                // from a grid point [m]
constexpr double kStandstill = 0.01;             // [m/s]
constexpr double kAligned = 0.05;                // with the way ahead [rad]
constexpr double kQuarter = 1.5707963267948966;  // of a turn [rad]
constexpr double kUnanswered = 0.5;              // after which something is sent again [s]

}  // namespace fleet
