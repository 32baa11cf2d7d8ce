// SPDX-License-Identifier: Apache-2.0
//
// Threads that share loops: over the robots of a world, or over many worlds. A turn of a loop
// writes nothing that another turn reads, so that the result does not depend on the number of
// threads, or on which of them takes a turn.
#pragma once

#include <memory>

#include "core/parallel/step_trial.h"

namespace kiva {

/// The caller and `threads` − 1 other threads, which are started on demand. Between the loops of a
/// step they stay awake, for microseconds and only while no other program needs their core, since a
/// step is over before a thread has woken; then they sleep. In a forked child, where they are gone,
/// others are started.
class Workers {
 public:
  /// A reference to a callable (int begin, int end), valid during the call. A world makes several
  /// of them in a step of a few microseconds; a std::function would allocate.
  class Loop {
   public:
    template <typename Callable>
    Loop(const Callable& callable)
        : callable_(&callable), call_([](const void* of, int begin, int end) {
            (*static_cast<const Callable*>(of))(begin, end);
          }) {}
    void operator()(int begin, int end) const { call_(callable_, begin, end); }

   private:
    const void* callable_;
    void (*call_)(const void* of, int begin, int end);
  };

  /// `threads`: 0 = as many as the machine has cores.
  explicit Workers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const { return threads_; }

  /// Calls loop(begin, end) until all of [0, count) is done, on as many threads as have `worth`
  /// turns each. If calls throw, the others are still made, and the first exception is thrown at
  /// the end.
  void share(int count, int worth, const Loop& loop);

  /// During its life, the loops of a world's step are shared only if a trial has shown that it is
  /// faster.
  class Step {
   public:
    explicit Step(Workers& workers) : workers_(workers) { workers.beginStep(); }
    ~Step() { workers_.endStep(); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    Workers& workers_;
  };

  /// Shares every loop, so that tests can share those of a small fleet.
  void shareAll() { shares_all_ = true; }

 private:
  struct Part;
  struct Job;
  struct Board;
  void beginStep() {
    in_step_ = true;
    trial_.beginStep();
  }
  void endStep() {
    if (has_loops_) trial_.endStep();
    in_step_ = has_loops_ = false;
  }
  bool mayShare() const;
  static void serve(const std::shared_ptr<Board>& board, int place);
  static void work(Job& job, int place);
  void shareOut(int count, int piece, int others, const Loop& loop);
  void start(int others);
  void quit();

  const unsigned threads_;
  bool shares_all_ = false;
  bool in_step_ = false, has_loops_ = false;  // the present step had loops to share
  StepTrial trial_;
  int process_ = 0;  // process that board_ and its threads belong to
  std::shared_ptr<Board> board_;
};

}  // namespace kiva
