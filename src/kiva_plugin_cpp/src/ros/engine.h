// SPDX-License-Identifier: Apache-2.0
//
// The step thread. It alone touches the world; whoever wants something of the world posts it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "pacer.h"
#include "reporter.h"

namespace kiva_ros {

class Engine {
 public:
  /// `rtf`: simulated seconds a wall second, 0 = as fast as it goes.
  Engine(kiva::World& world, Reporter& reporter, double rtf);
  ~Engine() { stop(); }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

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

  void pause(bool paused);
  /// From the step thread: another step size, or another pace (as in the constructor).
  void retime(double step_size, double rtf);
  bool paused() const { return paused_; }
  double targetFactor() const { return target_factor_; }
  /// Simulated seconds a wall second, measured over the last second.
  double realTimeFactor() const { return real_time_factor_; }

 private:
  using Requests = std::vector<std::function<void(kiva::World&)>>;

  void loop();
  void startClocks();
  bool waitForWork(Requests* requests);  ///< False when it is time to stop.
  void serve(const Requests& requests);
  void advance();
  void measure(int steps);
  void refuseRequests();

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
  bool moved_ = false;
  std::atomic<double> real_time_factor_{0};
  WallClock::time_point measured_since_;
  int measured_steps_ = 0;
};

template <typename Request>
auto Engine::run(Request request) {
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
auto Engine::move(Request request) {
  return run([this, request = std::move(request)](kiva::World& world) {
    moved_ = true;
    return request(world);
  });
}

}  // namespace kiva_ros
