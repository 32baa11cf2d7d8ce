// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/checkpoint_services.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ros/messages/step_rate.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

constexpr double kAutosaveRate = 1;  // [Hz], simulated
constexpr double kRounding = 1e-6;   // [s]

std::string seconds(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", time);
  return text;
}

}  // namespace

CheckpointServices::CheckpointServices(ros::NodeHandle& root, SimulationThread& simulation,
                                       const Options& options)
    : simulation_(simulation), options_(options), store_(options.folder, options.most_bytes) {
  servers_ = {serveCommand(root, "warehouse/checkpoint", &CheckpointServices::save, this),
              serveCommand(root, "warehouse/restore", &CheckpointServices::restore, this),
              serveCommand(root, "warehouse/undo", &CheckpointServices::undo, this)};
}

bool CheckpointServices::save(const Request& request, Response& response) {
  return reply(response, [&] {
    std::string bytes = simulation_.checkpoint();
    const std::string message = request.name + ": " + std::to_string(bytes.size()) + " bytes";
    store_.save(request.name, std::move(bytes));
    return message;
  });
}

bool CheckpointServices::restore(const Request& request, Response& response) {
  return reply(response, [&] {
    const double time = simulation_.restore(store_.load(request.name));
    return "back at " + seconds(time) + " of " + request.name;
  });
}

bool CheckpointServices::undo(const warehouse_msgs::Undo::Request& request,
                              warehouse_msgs::Undo::Response& response) {
  return reply(response, [&] {
    const double time =
        simulation_.run([&](kiva::World& world) { return undoHere(world, request.seconds); });
    response.stamp = ros::Time(time);
    return "back at " + seconds(time);
  });
}

double CheckpointServices::undoHere(kiva::World& world, double seconds_back) {
  if (!(std::isfinite(seconds_back) && seconds_back >= 0)) {
    throw ServiceRefusal("a finite number of seconds, 0 or more, was expected");
  }
  const auto is_old_enough = [&](const Saved& saved) {
    return age_ - saved.age >= seconds_back - kRounding;
  };
  const auto at = std::find_if(ring_.rbegin(), ring_.rend(), is_old_enough);
  if (at == ring_.rend()) {
    if (ring_.empty()) throw ServiceRefusal("nothing was saved yet: start with autosave:=60, say");
    throw ServiceRefusal("the oldest of " + std::to_string(ring_.size()) + " checkpoints is " +
                         seconds(age_ - ring_.front().age) + " old");
  }
  const Saved& saved = *at;
  simulation_.restoreHere(world, saved.bytes);
  age_ = saved.age;
  // Drops checkpoints of the time that was undone.
  while (!ring_.empty() && ring_.back().age > age_) {
    ring_bytes_ -= ring_.back().bytes.size();
    ring_.pop_back();
  }
  return world.time();
}

void CheckpointServices::remember(kiva::World& world) {
  const auto most = static_cast<std::size_t>(std::max(options_.autosave, 1));
  ring_.push_back({age_, world.checkpoint()});
  ring_bytes_ += ring_.back().bytes.size();
  while (ring_.size() > most || ring_bytes_ > options_.most_bytes) {
    ring_bytes_ -= ring_.front().bytes.size();
    ring_.pop_front();
  }
}

void CheckpointServices::beforeReset(kiva::World& world) {
  if (options_.undo) remember(world);
}

void CheckpointServices::afterStep(kiva::World& world) {
  age_ += world.stepSize();
  if (!options_.undo || options_.autosave == 0) return;
  if (world.steps() % stepsPer(kAutosaveRate, world.stepSize()) == 0) remember(world);
}

}  // namespace kiva_ros
