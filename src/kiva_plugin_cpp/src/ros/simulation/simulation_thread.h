// SPDX-License-Identifier: Apache-2.0
//
// The step thread. It alone touches the world; whoever wants something of the world posts it.
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
#include "pacer.h"
#include "ros/publishing/reporter.h"
#include "step_hook.h"

namespace kiva_ros {

class SimulationThread {
 public:
  /// `rtf`: simulated seconds a wall second, 0 = as fast as it goes. `lockstep`: time advances by
  /// step() alone.
  SimulationThread(kiva::World& world, Reporter& reporter, double rtf, bool lockstep);
  ~SimulationThread() { stop(); }
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  /// Before start().
  void add(StepHook& hook) { hooks_.push_back(&hook); }
  void start();
  /// Ends the thread. Requests that still wait are answered with an exception.
  void stop();
  /// Whether a step threw and thus ended the thread; it was logged.
  bool failed() const { return failed_; }

  /// Runs `request(world)` between two steps, paused or not, without waiting for it.
  void post(std::function<void(kiva::World&)> request);
  /// The same, and returns what it returns or throws. Not from the step thread.
  template <typename Request>
  auto run(Request request);
  /// The same for what moves models: who reads their states learns of it even while paused.
  template <typename Request>
  auto move(Request request);

  /// The same for what else changes the world, models that come and go aside: a recording has to
  /// know.
  template <typename Request>
  auto change(Request request);
  /// From the step thread: counts how often the world was reset or restored, from 1.
  std::uint32_t timeline() const { return reporter_.timeline(); }
  /// From the step thread: the world is being changed.
  void noteChange() { changed_ = true; }

  /// Gives the world a command at the next step, without waiting for it. In lockstep those that
  /// came since the last step are put in the order of their robots, since what comes over several
  /// connections has none of its own. Refused by an event where too many wait already, and where a
  /// reset or a restore comes before that step.
  void command(Orders orders);
  /// The same for what was decided upon in that timeline of the world: refused in any other.
  void command(Orders orders, std::uint32_t timeline);

  struct Stepped {
    double time = 0;          ///< Simulated [s].
    std::uint64_t steps = 0;  ///< Since time was 0.
    std::size_t waiting = 0;  ///< Commands for the next step.
  };
  /// Makes so many steps, paused or not, as fast as it goes; returns when all that they publish is
  /// with the sockets. `is_abandoned` is asked meanwhile, on the caller's thread: once it says so,
  /// the steps that are left are not made. Not from the step thread.
  Stepped step(std::uint32_t steps, const std::function<bool()>& is_abandoned);

  /// A checkpoint of the world.
  std::string checkpoint();
  /// Goes back, or ahead, to a checkpoint. Returns the time [s] then. Throws what World::restore
  /// throws.
  double restore(const std::string& checkpoint);
  /// The same on the step thread.
  void restoreHere(kiva::World& world, const std::string& checkpoint);

  /// Everything back to where it was spawned, and time too if `time_too`.
  void reset(bool time_too);
  void pause(bool paused);
  /// From the step thread: another step size, or another pace (as in the constructor).
  void retime(double step_size, double rtf);
  bool paused() const { return paused_; }
  double targetFactor() const { return target_factor_; }
  /// Simulated seconds a wall second, measured over the last second.
  double realTimeFactor() const { return real_time_factor_; }

 private:
  using Requests = std::vector<std::function<void(kiva::World&)>>;

  /// Steps that somebody waits for.
  struct StepRequest {
    std::uint32_t left = 0;
    std::shared_ptr<std::promise<Stepped>> done = std::make_shared<std::promise<Stepped>>();
    std::shared_ptr<std::atomic<bool>> is_cancelled = std::make_shared<std::atomic<bool>>(false);
  };

  bool runs() const { return !paused_ && !lockstep_; }  ///< By itself.
  void loop();
  void startClocks();
  bool waitForWork(Requests* requests);  ///< False when it is time to stop.
  void handleRequests(const Requests& requests);
  void advance();
  void runSteps(StepRequest& request);
  bool stepOnce(bool reliable);  ///< False if a hook wants no further step.
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
  std::atomic<double> target_factor_;
  std::thread thread_;
  std::atomic<bool> failed_{false};

  std::mutex mutex_;
  std::condition_variable wake_;
  Requests requests_;  ///< Guarded by mutex_, as is running_.
  bool running_ = false;
  std::atomic<bool> attention_{false};  ///< There are requests, or it is time to stop.

  std::atomic<bool> paused_{false};
  bool moved_ = false, changed_ = false;
  std::uint64_t models_revision_ = 0;  ///< Of which the hooks know.
  std::vector<StepHook*> hooks_;
  std::deque<StepRequest> step_requests_;
  Orders held_commands_;  ///< Until the next step.
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
