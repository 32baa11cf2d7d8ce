// SPDX-License-Identifier: Apache-2.0
#include "engine.h"

#include <ros/ros.h>

#include <algorithm>

namespace kiva_ros {

Engine::Engine(kiva::World& world, Reporter& reporter, double rtf)
    : world_(world), reporter_(reporter), pacer_(world.stepSize(), rtf), target_factor_(rtf) {}

void Engine::start() {
  running_ = true;
  thread_ = std::thread([this] {
    try {
      loop();
    } catch (const std::exception& error) {  // of a plugin, say
      ROS_FATAL("%s", error.what());
      failed_ = true;
      refuseRequests();
      ros::requestShutdown();
    }
  });
}

void Engine::stop() {
  refuseRequests();
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Engine::refuseRequests() {
  Requests unanswered;  // dies here, and with it the promises of its answers
  const std::lock_guard<std::mutex> lock(mutex_);
  running_ = false;
  attention_ = true;
  unanswered.swap(requests_);
}

void Engine::post(std::function<void(kiva::World&)> request) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!running_) return;
    requests_.push_back(std::move(request));
    attention_ = true;
  }
  wake_.notify_one();
}

void Engine::pause(bool paused) {
  run([this, paused](kiva::World&) {
    if (paused_ != paused) startClocks();
    paused_ = paused;
  });
}

void Engine::retime(double step_size, double rtf) {
  pacer_ = Pacer(step_size, rtf);
  target_factor_ = rtf;
  reporter_.retime(step_size, rtf);
  startClocks();
}

void Engine::startClocks() {
  const auto now = WallClock::now();
  pacer_.restart(now);
  measured_since_ = now;
  measured_steps_ = 0;
  real_time_factor_ = 0;
}

void Engine::loop() {
  startClocks();
  for (Requests requests; waitForWork(&requests);) {
    serve(requests);
    if (!paused_) advance();
  }
}

bool Engine::waitForWork(Requests* requests) {
  // Within an hour, since waiting until the end of all time overflows in some libraries.
  auto until = std::min(reporter_.nextDue(), WallClock::now() + std::chrono::hours(1));
  if (!paused_) until = std::min(until, pacer_.next());
  std::unique_lock<std::mutex> lock(mutex_);
  if (until > WallClock::time_point::min()) {
    wake_.wait_until(lock, until, [this] { return attention_.load(); });
  }
  attention_ = !running_;
  *requests = std::exchange(requests_, {});
  return running_;
}

void Engine::serve(const Requests& requests) {
  for (const auto& request : requests) request(world_);
  reporter_.afterRequests(world_, paused_, std::exchange(moved_, false));
}

void Engine::advance() {
  const int due = pacer_.due(WallClock::now());
  int steps = 0;
  // At least one, or a flood of requests would hold time up.
  while (steps < due && (steps == 0 || !attention_)) {
    world_.step();
    pacer_.stepped();
    reporter_.afterStep(world_);
    ++steps;
  }
  measure(steps);
}

void Engine::measure(int steps) {
  measured_steps_ += steps;
  const auto now = WallClock::now();
  const double wall = std::chrono::duration<double>(now - measured_since_).count();
  if (wall < 1) return;
  real_time_factor_ = measured_steps_ * world_.stepSize() / wall;
  measured_since_ = now;
  measured_steps_ = 0;
}

}  // namespace kiva_ros
