// SPDX-License-Identifier: Apache-2.0
#include "core/parallel/workers.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kiva {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

// Time for which a thread stays awake between two loops. Waking takes 20 µs and costs the waker 7
// µs; the loops of a step, with the time between them, last no longer.
constexpr microseconds kPatience{50};
// Longest duration of an interrupt. A longer absence means that a program needs the core, which is
// then left to it for kLeft times that duration.
constexpr microseconds kInterrupt{100};
constexpr int kLeft = 5;
constexpr int kPieces = 4;  // least number of pieces in which a thread takes its turns

/// Returns whether other programs need the calling thread's core.
bool isCoreWanted() {
  static thread_local Clock::time_point left_until;
  const auto before = Clock::now();
  if (before < left_until) return true;
  std::this_thread::yield();
  const auto taken = Clock::now() - before;
  if (taken > kInterrupt) left_until = before + kLeft * taken;
  return taken > kInterrupt;
}

/// Waits actively until is_over() or until the patience ends. Returns whether it is over.
template <typename IsOver>
bool awaitAwake(IsOver isOver) {
  const auto latest = Clock::now() + kPatience;
  while (!isOver()) {
    if (Clock::now() > latest) return false;
  }
  return true;
}

}  // namespace

/// The part of a loop with which one thread begins, before it helps with another's. So the same
/// robots mostly stay in the same core's cache. Each part has a cache line of its own.
struct alignas(64) Workers::Part {
  std::atomic<int> next{0};
  int end = 0;
};

struct Workers::Job {
  const Loop& loop;
  const int piece;
  Part* const parts;
  const int count;   // number of parts
  std::mutex mutex;  // guards the error
  std::exception_ptr error = nullptr;
};

/// The state shared by the threads; it lives until the last of them has left.
struct Workers::Board {
  explicit Board(int others) : hands(others), parts(others + 1) {}

  bool isOpen() const { return (state & kOpen) != 0; }
  void post(int others);
  void await();
  bool join();
  void leave();
  void finish();

  static constexpr unsigned kOpen = 1u << 31;

  const int hands;  // number of threads besides the caller
  std::vector<Part> parts;
  Job* job = nullptr;              // valid while `state` is not 0
  std::atomic<unsigned> state{0};  // number of other threads in the job; kOpen: more may join
  std::atomic<bool> quits{false};

  std::mutex mutex;  // guards sleeping threads
  std::condition_variable posted, left;
  std::atomic<int> asleep{0};
  std::atomic<bool> caller_sleeps{false};
};

/// Opens the job to other threads, and wakes `others` of them if they sleep.
void Workers::Board::post(int others) {
  state = kOpen;
  if (asleep == 0) return;
  {
    const std::lock_guard<std::mutex> lock(mutex);
  }  // a thread that missed the change sleeps by now
  for (int i = 0; i < others; ++i) posted.notify_one();
}

/// Waits until there may be a job to join, or the program ends.
void Workers::Board::await() {
  const auto isOver = [&] { return isOpen() || quits; };
  if (!isCoreWanted() && awaitAwake(isOver)) return;
  std::unique_lock<std::mutex> lock(mutex);
  ++asleep;
  posted.wait(lock, isOver);
  --asleep;
}

bool Workers::Board::join() {
  unsigned now = state;
  while (now & kOpen) {
    if (state.compare_exchange_weak(now, now + 1)) return true;
  }
  return false;
}

/// Leaves a job without remaining turns.
void Workers::Board::leave() {
  state &= ~kOpen;
  if (--state > 0 || !caller_sleeps) return;
  { const std::lock_guard<std::mutex> lock(mutex); }
  left.notify_one();
}

/// Closes the job and waits for the threads that have joined. Sleeping ones stay asleep.
void Workers::Board::finish() {
  state &= ~kOpen;
  const auto isOver = [&] { return state == 0; };
  if (awaitAwake(isOver)) return;
  std::unique_lock<std::mutex> lock(mutex);
  caller_sleeps = true;
  left.wait(lock, isOver);
  caller_sleeps = false;
}

Workers::Workers(unsigned threads)
    : threads_(threads ? threads : std::max(1u, std::thread::hardware_concurrency())) {}

Workers::~Workers() { quit(); }

void Workers::quit() {
  if (!board_ || process_ != getpid()) return;
  {
    const std::lock_guard<std::mutex> lock(board_->mutex);
    board_->quits = true;
  }
  board_->posted.notify_all();
}

/// Starts detached threads, since a forked child could not join them.
void Workers::start(int others) {
  if (board_ && process_ == getpid() && board_->hands >= others) return;
  quit();
  process_ = getpid();
  board_ = std::make_shared<Board>(others);
  for (int place = 1; place <= others; ++place) std::thread(serve, board_, place).detach();
}

/// Returns whether loops that are worth it are shared now.
bool Workers::mayShare() const { return !in_step_ || shares_all_ || trial_.shares(); }

void Workers::share(int count, int worth, const Loop& loop) {
  if (count <= 0) return;
  if (shares_all_) worth = 1;
  if (count <= worth) return loop(0, count);  // the usual case for a small fleet
  const int others = std::min(count / worth, static_cast<int>(threads_)) - 1;
  has_loops_ = has_loops_ || (in_step_ && others > 0);
  if (others > 0 && mayShare()) return shareOut(count, (worth - 1) / kPieces + 1, others, loop);
  Part all;
  all.end = count;
  Job job{loop, worth, &all, 1, {}, {}};
  work(job, 0);
  if (job.error) std::rethrow_exception(job.error);
}

void Workers::shareOut(int count, int piece, int others, const Loop& loop) {
  start(others);
  Board& board = *board_;
  const long pieces = (count - 1) / piece + 1;
  Job job{loop, piece, board.parts.data(), others + 1, {}, {}};
  const auto begin = [&](int k) { return static_cast<int>(k * pieces / job.count) * piece; };
  for (int k = 0; k < job.count; ++k) {
    board.parts[k].next = begin(k);
    board.parts[k].end = std::min(count, begin(k + 1));
  }
  board.job = &job;
  board.post(others);
  work(job, 0);
  board.finish();
  if (job.error) std::rethrow_exception(job.error);
}

void Workers::serve(const std::shared_ptr<Board>& board, int place) {
  while (!board->quits) {
    board->await();
    if (!board->join()) continue;
    work(*board->job, place);
    board->leave();
  }
}

/// Takes turns, from the thread's own part on; `place` is its index among the threads.
void Workers::work(Job& job, int place) {
  for (int k = 0; k < job.count; ++k) {
    Part& part = job.parts[(place + k) % job.count];
    for (int begin; (begin = part.next.fetch_add(job.piece)) < part.end;) {
      try {
        job.loop(begin, std::min(begin + job.piece, part.end));
      } catch (...) {
        const std::lock_guard<std::mutex> lock(job.mutex);
        if (!job.error) job.error = std::current_exception();
      }
    }
  }
}

}  // namespace kiva
