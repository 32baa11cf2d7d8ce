// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/state/world/clock.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// What clients are told of what happened, until they take it.
struct EventLog {
  explicit EventLog(const Clock& clock) : clock(clock) {}

  std::vector<Event> events;
  std::vector<StatusChange> status_changes;
  std::vector<std::string> warnings;
  std::set<std::string> warned;  ///< Subjects of all warnings, taken or not.
  const Clock& clock;

  /// Adds an event of this moment; `command` is the number of the command that it is about, 0 =
  /// none.
  void report(Event::Kind kind, const std::string& model, const std::string& other,
              const std::string& text, const Impact& impact = {}, std::uint32_t command = 0) {
    events.push_back({clock.time(), kind, model, other, text, command, impact});
  }
  /// Adds a warning, once for each `subject`.
  void warn(const std::string& subject, const std::string& text) {
    if (warned.insert(subject).second) warnings.push_back(text);
  }
};

}  // namespace kiva
