// SPDX-License-Identifier: Apache-2.0
//
// The threads that share loops: over the robots of a world, or over many worlds. A loop's turns
// touch nothing that another one reads, so that its result does not depend on how many threads
// there are or which of them takes a turn.
#pragma once

#include <memory>

#include "core/parallel/step_trial.h"

namespace kiva {

/// The caller and `threads` − 1 others, which are started when there is work for them. Between the
/// loops of a step they stay awake, for microseconds and if no other program wants their core,
/// since a step is over before one has woken; then they sleep. In a forked child, where they are
/// gone, others are started.
class Workers {
 public:
  /// A callable (int begin, int end), referred to for as long as it is called: a world makes
  /// several of them in a step of some microseconds, and a std::function would be on the heap.
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

  /// 0: as many as the machine has cores.
  explicit Workers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const { return threads_; }

  /// Calls loop(begin, end) until all of [0, count) is done, on as many threads as have `worth`
  /// turns each: for fewer it is not worth waking one. If some throw, the others are done
  /// nevertheless, and what the first of them threw is thrown then.
  void share(int count, int worth, const Loop& loop);

  /// While it lives, the loops of a world's step are shared out only if a trial has shown that this
  /// is worth it.
  class Step {
   public:
    explicit Step(Workers& workers) : workers_(workers) { workers.beginStep(); }
    ~Step() { workers_.endStep(); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    Workers& workers_;
  };

  /// For tests: one turn is worth it, so that a small fleet is shared too.
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
  bool in_step_ = false, has_loops_ = false;  // that step had some to share
  StepTrial trial_;
  int process_ = 0;  // that board_ and its threads belong to
  std::shared_ptr<Board> board_;
};

}  // namespace kiva
