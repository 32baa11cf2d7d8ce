// SPDX-License-Identifier: Apache-2.0
//
// The step thread. It alone touches the world; other threads post requests to it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "pace_limit.h"
#include "pacer.h"
#include "ros/publishing/reporter.h"
#include "step_hook.h"

namespace kiva_ros {

class SimulationThread {
 public:
  /// `rtf`: simulated seconds a wall second; 0 = as fast as possible. `lockstep`: only step()
  /// advances time.
  SimulationThread(kiva::World& world, Reporter& reporter, double rtf, bool lockstep);
  ~SimulationThread() { stop(); }
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  /// Adds a hook; call it before start().
  void add(StepHook& hook) { hooks_.push_back(&hook); }
  void start();
  /// Ends the thread and answers the requests that still wait with an exception.
  void stop();
  /// Returns whether an exception in a step has ended the thread; it was logged.
  bool failed() const { return failed_; }

  /// Runs `request(world)` between two steps, paused or not, without waiting for it.
  void post(std::function<void(kiva::World&)> request);
  /// Runs a request like post(), waits, and returns its result or throws its exception. Not for the
  /// step thread.
  template <typename Request>
  auto run(Request request);
  /// Runs a request like run() that moves models: their states are published even while paused.
  template <typename Request>
  auto move(Request request);

  /// Runs a request like run() that changes the world otherwise, so that a recording includes the
  /// change. Added and removed models are always recorded.
  template <typename Request>
  auto change(Request request);
  /// Returns the number of the timeline: it begins with 1 and grows with each reset or restore. For
  /// the step thread.
  std::uint32_t timeline() const { return reporter_.timeline(); }
  /// Notes that a request changes the world. For the step thread.
  void noteChange() { changed_ = true; }

  /// Keeps the messages of all objects and of the scenery back, while many models come and go, or
  /// no longer. For the step thread, like the next one.
  void holdObjects(bool held) { reporter_.holdObjects(held); }
  bool areObjectsHeld() const { return reporter_.areObjectsHeld(); }

  /// Posts commands for the next step, without waiting for it. In lockstep the commands since the
  /// last step are sorted by robot, since several connections have no common order. Commands are
  /// refused by an event if too many are pending, or if a reset or a restore precedes that step.
  void command(Orders orders);
  /// Posts commands that are valid in that timeline of the world, and refuses them in any other.
  void command(Orders orders, std::uint32_t timeline);

  struct Stepped {
    double time = 0;          ///< Simulated [s].
    std::uint64_t steps = 0;  ///< Steps since time was 0.
    std::size_t waiting = 0;  ///< Commands for the next step.
  };
  /// Makes `steps` steps, paused or not, as fast as possible, and returns when all their messages
  /// have been written to sockets. Calls `is_abandoned` meanwhile, on the caller's thread: once it
  /// returns true, the remaining steps are skipped. Not for the step thread.
  Stepped step(std::uint32_t steps, const std::function<bool()>& is_abandoned);

  /// Returns a checkpoint of the world.
  std::string checkpoint();
  /// Restores a checkpoint and returns its time [s]. Throws as World::restore does.
  double restore(const std::string& checkpoint);
  /// Restores a checkpoint, on the step thread.
  void restoreHere(kiva::World& world, const std::string& checkpoint);

  /// Puts everything back to where it was spawned, and time to 0 if `time_too`.
  void reset(bool time_too);
  void pause(bool paused);
  /// Changes the step size and the pace (as in the constructor). For the step thread.
  void retime(double step_size, double rtf);
  /// Has time wait for a node that is still to start, as limitPace() does. Before start().
  void awaitNode(const std::string& node, double until);
  /// Has simulated time wait for a node: it passes `until` [s] only after another call for that
  /// node. Time that passes as fast as the wall clock, or slower, waits for no one, like step().
  void limitPace(const std::string& node, double until);
  /// Has time wait for that node no longer.
  void releasePace(const std::string& node);
  bool paused() const { return paused_; }
  double targetFactor() const { return target_factor_; }
  /// Returns simulated seconds a wall second, measured over the last second.
  double realTimeFactor() const { return real_time_factor_; }

 private:
  using Requests = std::vector<std::function<void(kiva::World&)>>;

  /// A call of step() that waits for its steps.
  struct StepRequest {
    std::uint32_t left = 0;
    std::shared_ptr<std::promise<Stepped>> done = std::make_shared<std::promise<Stepped>>();
    std::shared_ptr<std::atomic<bool>> is_cancelled = std::make_shared<std::atomic<bool>>(false);
  };

  bool runs() const { return !paused_ && !lockstep_; }  ///< Whether time advances without step().
  void loop();
  void startClocks();
  void beginTimeline();
  bool waitForWork(Requests* requests);  ///< Returns false when the thread is to end.
  void handleRequests(const Requests& requests);
  void advance();
  void runSteps(StepRequest& request);
  bool stepOnce(bool reliable);  ///< Returns false if a hook prevents further steps.
  bool isHeld();                 ///< Returns whether time waits for a node that keeps pace.
  void hold();
  void takeOrders(const Orders& orders);
  void postCommands();
  void refuse(const Orders& orders, const std::string& why);
  void refuseCommands(const std::string& why);
  void measure(int steps);
  void refuseRequests();

  const bool lockstep_;
  kiva::World& world_;
  Reporter& reporter_;
  Pacer pacer_;
  PaceLimit pace_limit_;
  bool held_ = false;                 ///< Time waits for a node that keeps pace,
  WallClock::time_point held_since_;  ///< since then.
  std::atomic<double> target_factor_;
  std::thread thread_;
  std::atomic<bool> failed_{false};

  std::mutex mutex_;
  std::condition_variable wake_;
  Requests requests_;  ///< Guarded by mutex_, as is running_.
  bool running_ = false;
  std::atomic<bool> attention_{false};  ///< There are requests, or the thread is to end.

  std::atomic<bool> paused_{false};
  bool moved_ = false, changed_ = false;
  std::uint64_t models_revision_ = 0;  ///< The revision that the hooks know.
  std::vector<StepHook*> hooks_;
  std::deque<StepRequest> step_requests_;
  Orders held_commands_;  ///< Commands for the next step.
  std::atomic<double> real_time_factor_{0};
  WallClock::time_point measured_since_;
  int measured_steps_ = 0;
};

template <typename Request>
auto SimulationThread::run(Request request) {
  using Result = std::invoke_result_t<Request, kiva::World&>;
  auto task = std::make_shared<std::packaged_task<Result(kiva::World&)>>(std::move(request));
  auto result = task->get_future();
  post([task = std::move(task)](kiva::World& world) { (*task)(world); });
  try {
    return result.get();
  } catch (const std::future_error&) {
    throw std::runtime_error("the simulation is shutting down");
  }
}

template <typename Request>
auto SimulationThread::change(Request request) {
  return run([this, request = std::move(request)](kiva::World& world) {
    changed_ = true;
    return request(world);
  });
}

template <typename Request>
auto SimulationThread::move(Request request) {
  return change([this, request = std::move(request)](kiva::World& world) {
    moved_ = true;
    return request(world);
  });
}

}  // namespace kiva_ros
