// SPDX-License-Identifier: Apache-2.0
#include "core/control/radio.h"

#include <algorithm>
#include <utility>

#include "core/state/random_stream.h"

namespace kiva {
namespace {

void arrive(WorldState& world, const Command& command, FollowPath path) {
  world.commands.push_back(command);
  if (command.kind == Command::Kind::kFollow) world.paths.push_back(std::move(path));
}

bool isWired(const Command& command) {
  return command.kind == Command::Kind::kStop || command.kind == Command::Kind::kGoOn;
}

/// The step at which a message sent now is there: never before one that was sent to the same robot
/// earlier.
std::uint64_t arrival(const WorldState& world, int kiva_id, RandomStream* random) {
  const RadioRealism& real = world.realism.radio;
  const double rest = std::max(0.0, real.latency_mean - real.latency_least);
  std::uint64_t due =
      world.total_steps + world.stepsIn(real.latency_least + random->exponential(rest));
  for (const RadioMessage& other : world.on_air) {
    if (other.command.kiva_id == kiva_id) due = std::max(due, other.due);
  }
  return due;
}

void put(WorldState& world, RadioMessage message) {
  const auto later = [](const RadioMessage& a, const RadioMessage& b) { return a.due < b.due; };
  const auto at = std::upper_bound(world.on_air.begin(), world.on_air.end(), message, later);
  world.on_air.insert(at, std::move(message));
}

}  // namespace

void send(WorldState& world, const Command& command, FollowPath path) {
  const RadioRealism& real = world.realism.radio;
  if (!real.enabled || isWired(command)) return arrive(world, command, std::move(path));
  RandomStream random(world.options.seed, Matter::kCommand, 0, world.radio_messages++);
  if (random.chance(real.lost)) return;
  const bool is_repeated = random.chance(real.repeated);
  put(world, {arrival(world, command.kiva_id, &random), command, path});
  if (is_repeated) {
    put(world, {arrival(world, command.kiva_id, &random), command, std::move(path)});
  }
}

void receive(WorldState& world) {
  while (!world.on_air.empty() && world.on_air.front().due <= world.total_steps) {
    RadioMessage& message = world.on_air.front();
    arrive(world, message.command, std::move(message.path));
    world.on_air.pop_front();
  }
}

void forgetMessages(WorldState& world) {
  world.on_air.clear();
  world.reports_on_air.clear();
}

}  // namespace kiva
