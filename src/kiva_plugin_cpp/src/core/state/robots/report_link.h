// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// A report of a robot, on its way to the clients.
struct ReportMessage {
  std::uint64_t due = 0;     ///< The total step at which it arrives.
  std::uint64_t number = 0;  ///< In the order in which they were sent.
  int kiva_id = 0;
  RobotReport report;
};

/// The radio by which robots report.
struct ReportLink {
  std::vector<ReportMessage> messages;  ///< A heap, the next to arrive first.
  std::uint64_t sent = 0;               ///< Reports, ever.
  std::vector<int> changed;  ///< Ids of robots whose status has changed since the last step.
};

}  // namespace kiva
