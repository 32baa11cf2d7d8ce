// SPDX-License-Identifier: Apache-2.0
#include "core/communication/command_link.h"

#include <algorithm>
#include <utility>

#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

bool isWired(const Command& command) {
  return command.kind == Command::Kind::kStop || command.kind == Command::Kind::kGoOn;
}

/// Returns the step at which a message sent now arrives: never before an earlier message to the
/// same robot.
std::uint64_t arrival(const CommandLink& link, const Scene& world, int kiva_id,
                      RandomStream* random) {
  const RadioRealism& real = world.settings.realism.radio;
  const double rest = std::max(0.0, real.latency_mean - real.latency_least);
  std::uint64_t due =
      world.clock.total_steps + world.clock.stepsIn(real.latency_least + random->exponential(rest));
  for (const CommandMessage& other : link.messages) {
    if (other.pending.command.kiva_id == kiva_id) due = std::max(due, other.due);
  }
  return due;
}

void put(CommandLink& link, CommandMessage message) {
  const auto later = [](const CommandMessage& a, const CommandMessage& b) { return a.due < b.due; };
  const auto at = std::upper_bound(link.messages.begin(), link.messages.end(), message, later);
  link.messages.insert(at, std::move(message));
}

}  // namespace

void send(CommandLink& link, Inbox& inbox, const Scene& world, PendingCommand command) {
  const RadioRealism& real = world.settings.realism.radio;
  if (!real.enabled || isWired(command.command)) {
    return inbox.pending.push_back(std::move(command));
  }
  RandomStream random(world.settings.options.seed, Matter::kCommand, 0, link.sent++);
  if (random.chance(real.lost)) return;
  const bool is_repeated = random.chance(real.repeated);
  const int kiva_id = command.command.kiva_id;
  put(link, {arrival(link, world, kiva_id, &random), command});
  if (is_repeated) put(link, {arrival(link, world, kiva_id, &random), std::move(command)});
}

void receive(CommandLink& link, Inbox& inbox, const Clock& clock) {
  while (!link.messages.empty() && link.messages.front().due <= clock.total_steps) {
    inbox.pending.push_back(std::move(link.messages.front().pending));
    link.messages.pop_front();
  }
}

}  // namespace kiva
