// SPDX-License-Identifier: Apache-2.0
#include "simulation_thread.h"

#include <ros/ros.h>

#include <algorithm>
#include <utility>

namespace kiva_ros {
namespace {

constexpr std::size_t kMostWaitingCommands = 100000;
constexpr auto kAbandonedCheck = std::chrono::milliseconds(100);
constexpr auto kHeldCheck = std::chrono::milliseconds(100);

}  // namespace

SimulationThread::SimulationThread(kiva::World& world, Reporter& reporter, double rtf,
                                   bool lockstep)
    : lockstep_(lockstep),
      world_(world),
      reporter_(reporter),
      pacer_(world.stepSize(), rtf),
      target_factor_(rtf),
      models_revision_(world.modelsRevision()) {}

void SimulationThread::start() {
  running_ = true;
  thread_ = std::thread([this] {
    try {
      loop();
    } catch (const std::exception& error) {  // from a plugin, for instance
      ROS_FATAL("%s", error.what());
      failed_ = true;
      refuseRequests();
      ros::requestShutdown();
    }
    step_requests_.clear();  // with the promises of their answers
  });
}

void SimulationThread::stop() {
  refuseRequests();
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void SimulationThread::refuseRequests() {
  Requests unanswered;  // destroyed here, with the promises of its answers
  const std::lock_guard<std::mutex> lock(mutex_);
  running_ = false;
  attention_ = true;
  unanswered.swap(requests_);
}

void SimulationThread::post(std::function<void(kiva::World&)> request) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!running_) return;
    requests_.push_back(std::move(request));
    attention_ = true;
  }
  wake_.notify_one();
}

void SimulationThread::command(Orders orders) {
  post([this, orders = std::move(orders)](kiva::World&) { takeOrders(orders); });
}

void SimulationThread::command(Orders orders, std::uint32_t timeline) {
  post([this, orders = std::move(orders), timeline](kiva::World&) {
    if (timeline == reporter_.timeline()) return takeOrders(orders);
    refuse(orders, "it was asked before the world was reset or restored");
  });
}

void SimulationThread::takeOrders(const Orders& orders) {
  for (const Order& order : orders) {
    const std::size_t waiting = held_commands_.size();
    if (waiting < kMostWaitingCommands) {
      held_commands_.push_back(order);
    } else {
      reporter_.refused(world_, robotOf(order),
                        std::to_string(waiting) + " commands wait for the next step");
    }
  }
}

void SimulationThread::postCommands() {
  const auto by_robot = [](const Order& a, const Order& b) { return robotOf(a) < robotOf(b); };
  if (lockstep_) std::stable_sort(held_commands_.begin(), held_commands_.end(), by_robot);
  for (Order& order : held_commands_) {
    for (StepHook* hook : hooks_) hook->onCommand(order);
    std::visit([this](auto& asked) { world_.post(std::move(asked)); }, order);
  }
  held_commands_.clear();
}

void SimulationThread::refuse(const Orders& orders, const std::string& why) {
  for (const Order& order : orders) reporter_.refused(world_, robotOf(order), why);
}

void SimulationThread::refuseCommands(const std::string& why) {
  refuse(held_commands_, why);
  held_commands_.clear();
}

SimulationThread::Stepped SimulationThread::step(std::uint32_t steps,
                                                 const std::function<bool()>& is_abandoned) {
  StepRequest request;
  request.left = steps;
  auto done = request.done->get_future();
  const auto is_cancelled = request.is_cancelled;
  post([this, request = std::move(request)](kiva::World&) { step_requests_.push_back(request); });
  while (done.wait_for(kAbandonedCheck) != std::future_status::ready) {
    if (is_abandoned()) *is_cancelled = true;
  }
  try {
    return done.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the simulation is shutting down");
  }
}

std::string SimulationThread::checkpoint() {
  return run([](kiva::World& world) { return world.checkpoint(); });
}

double SimulationThread::restore(const std::string& checkpoint) {
  return run([&](kiva::World& world) {
    restoreHere(world, checkpoint);
    return world.time();
  });
}

void SimulationThread::restoreHere(kiva::World& world, const std::string& checkpoint) {
  const std::vector<std::string> before = world.modelNames();
  world.restore(checkpoint);
  moved_ = changed_ = true;
  beginTimeline();
  reporter_.restored(world, before);
  refuseCommands("the world went back to a checkpoint before its next step");
  retime(world.stepSize(), target_factor_);  // its step size may differ
}

void SimulationThread::beginTimeline() {
  pace_limit_.releaseAll();  // what nodes have said was of another timeline
  reporter_.beginTimeline();
}

void SimulationThread::reset(bool time_too) {
  move([this, time_too](kiva::World& world) {
    for (StepHook* hook : hooks_) hook->beforeReset(world);
    world.reset(time_too);
    beginTimeline();
    refuseCommands("the world was reset before its next step");
  });
}

void SimulationThread::pause(bool paused) {
  run([this, paused](kiva::World&) {
    if (paused_ != paused) startClocks();
    held_ = false;  // by a node; who keeps a pause waiting is not measured
    paused_ = paused;
  });
}

void SimulationThread::awaitNode(const std::string& node, double until) {
  pace_limit_.await(node, until, WallClock::now());
  if (pacer_.isFast()) {
    ROS_INFO("time stands at %g s until %s has started, for %d s at most", until, node.c_str(),
             static_cast<int>(PaceLimit::kMostStart.count()));
  }
}

void SimulationThread::limitPace(const std::string& node, double until) {
  post([this, node, until](kiva::World&) { pace_limit_.allow(node, until, WallClock::now()); });
}

void SimulationThread::releasePace(const std::string& node) {
  post([this, node](kiva::World&) { pace_limit_.release(node); });
}

void SimulationThread::retime(double step_size, double rtf) {
  pacer_ = Pacer(step_size, rtf);
  target_factor_ = rtf;
  reporter_.retime(step_size, rtf);
  startClocks();
}

void SimulationThread::startClocks() {
  const auto now = WallClock::now();
  pacer_.restart(now);
  measured_since_ = now;
  measured_steps_ = 0;
  real_time_factor_ = 0;
}

void SimulationThread::loop() {
  startClocks();
  for (Requests requests; waitForWork(&requests);) {
    handleRequests(requests);
    if (!step_requests_.empty()) {
      runSteps(step_requests_.front());
    } else if (runs()) {
      advance();
    }
  }
}

bool SimulationThread::waitForWork(Requests* requests) {
  // Waits an hour at most, since waiting until the end of all time overflows in some libraries.
  auto until = std::min(reporter_.nextDue(), WallClock::now() + std::chrono::hours(1));
  if (runs()) until = std::min(until, held_ ? WallClock::now() + kHeldCheck : pacer_.next());
  if (!step_requests_.empty()) until = WallClock::time_point::min();
  std::unique_lock<std::mutex> lock(mutex_);
  if (until > WallClock::time_point::min()) {
    wake_.wait_until(lock, until, [this] { return attention_.load(); });
  }
  attention_ = !running_;
  *requests = std::exchange(requests_, {});
  return running_;
}

void SimulationThread::handleRequests(const Requests& requests) {
  for (const auto& request : requests) request(world_);
  if (world_.modelsRevision() != models_revision_) changed_ = true;
  models_revision_ = world_.modelsRevision();
  if (std::exchange(changed_, false)) {
    for (StepHook* hook : hooks_) hook->onChange();
  }
  reporter_.afterRequests(world_, !runs() || held_, std::exchange(moved_, false));
}

void SimulationThread::advance() {
  if (isHeld()) return hold();
  held_ = false;
  const int due = pacer_.due(WallClock::now());
  int steps = 0;
  // At least one step, or a flood of requests would stop time.
  while (steps < due && (steps == 0 || !attention_) && !isHeld()) {
    if (!stepOnce(false)) return;
    pacer_.stepped();
    ++steps;
  }
  measure(steps);
}

bool SimulationThread::isHeld() { return pacer_.isFast() && pace_limit_.holds(world_.time()); }

/// Time stands still, so subscribers get what has not been due yet: they may wait for it, while the
/// world waits for them.
void SimulationThread::hold() {
  const auto now = WallClock::now();
  if (!std::exchange(held_, true)) {
    held_since_ = now;
    reporter_.held(world_);
  }
  for (const auto& silent : pace_limit_.releaseSilent(world_.time(), held_since_, now)) {
    ROS_WARN(
        "%s has kept simulated time waiting for %d s at %g s: time passes without it until it "
        "publishes on /warehouse/pace again",
        silent.node.c_str(), static_cast<int>(silent.patience.count()), world_.time());
  }
  measure(0);
}

void SimulationThread::runSteps(StepRequest& request) {
  int steps = 0;
  while (request.left > 0 && (steps == 0 || !attention_)) {
    if (*request.is_cancelled || !stepOnce(true)) {
      request.left = 0;
      break;
    }
    --request.left;
    ++steps;
  }
  measure(steps);
  if (request.left > 0) return;
  reporter_.whenPublished(
      world_, [done = request.done,
               stepped = Stepped{world_.time(), world_.steps(), held_commands_.size()}] {
        done->set_value(stepped);
      });
  step_requests_.pop_front();
  if (runs()) startClocks();
}

bool SimulationThread::stepOnce(bool reliable) {
  if (!held_commands_.empty()) postCommands();
  for (StepHook* hook : hooks_) {
    if (hook->beforeStep(world_)) continue;
    paused_ = true;
    return false;
  }
  world_.step();
  for (StepHook* hook : hooks_) hook->afterStep(world_);
  models_revision_ = world_.modelsRevision();  // plugins repeat their own changes
  reporter_.afterStep(world_, reliable);
  return true;
}

void SimulationThread::measure(int steps) {
  measured_steps_ += steps;
  const auto now = WallClock::now();
  const double wall = std::chrono::duration<double>(now - measured_since_).count();
  if (wall < 1) return;
  real_time_factor_ = measured_steps_ * world_.stepSize() / wall;
  measured_since_ = now;
  measured_steps_ = 0;
}

}  // namespace kiva_ros
