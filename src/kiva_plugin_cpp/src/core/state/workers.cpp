// SPDX-License-Identifier: Apache-2.0
#include "core/state/workers.h"

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

// Between two loops a thread stays awake for so long: to wake it takes 20 µs, and who wakes it 7,
// and the loops of a step, with what lies between them, last no longer.
constexpr microseconds kPatience{50};
// A core that was gone for longer than this when it was offered to others is wanted by them;
constexpr microseconds kWanted{200};
constexpr microseconds kRest{10'000};  // for so long then it is left to them at once.
constexpr int kPieces = 4;             // that a thread takes its turns in, at least

}  // namespace

/// What one thread begins with; who has done with its own goes on with another's. So the same robots
/// mostly stay in the same core's cache. In a cache line of its own.
struct alignas(64) Workers::Part {
  std::atomic<int> next{0};
  int end = 0;
};

struct Workers::Job {
  const Loop& loop;
  const int piece;
  Part* const parts;
  const int count;   // of the parts
  std::mutex mutex;  // of the error
  std::exception_ptr error = nullptr;
};

/// What the threads read; it lives until the last of them has left.
struct Workers::Board {
  explicit Board(int others) : hands(others), parts(others + 1) {}

  bool isOpen() const { return (state & kOpen) != 0; }
  void post(int others);
  void await();
  bool join();
  void leave();
  void finish();

  static constexpr unsigned kOpen = 1u << 31;

  const int hands;  // threads beside the caller
  std::vector<Part> parts;
  Job* job = nullptr;              // while `state` is not 0
  std::atomic<unsigned> state{0};  // how many of the others are at it; kOpen: more may join
  std::atomic<bool> quits{false};

  std::mutex mutex;  // of those that sleep
  std::condition_variable posted, left;
  std::atomic<int> asleep{0};
  std::atomic<bool> caller_sleeps{false};

 private:
  bool stayAwake() const;
};

/// Opens the job for others, and wakes so many of them if they sleep.
void Workers::Board::post(int others) {
  state = kOpen;
  if (asleep == 0) return;
  { const std::lock_guard<std::mutex> lock(mutex); }  // who did not see it sleeps by then
  for (int i = 0; i < others; ++i) posted.notify_one();
}

/// Until there may be a job to join, or to quit.
void Workers::Board::await() {
  if (stayAwake()) return;
  std::unique_lock<std::mutex> lock(mutex);
  ++asleep;
  posted.wait(lock, [&] { return isOpen() || quits; });
  --asleep;
}

/// The same without sleep. False: it was in vain, or others want the core.
bool Workers::Board::stayAwake() const {
  static thread_local Clock::time_point rests_until;
  auto now = Clock::now();
  const auto latest = now + kPatience;
  while (!isOpen() && !quits) {
    if (now < rests_until || now > latest) return false;
    const auto before = now;
    std::this_thread::yield();
    now = Clock::now();
    if (now - before > kWanted) rests_until = now + kRest;
  }
  return true;
}

bool Workers::Board::join() {
  unsigned now = state;
  while (now & kOpen) {
    if (state.compare_exchange_weak(now, now + 1)) return true;
  }
  return false;
}

/// Nothing of the job is left to take.
void Workers::Board::leave() {
  state &= ~kOpen;
  if (--state > 0 || !caller_sleeps) return;
  { const std::lock_guard<std::mutex> lock(mutex); }
  left.notify_one();
}

/// Waits for those that have joined by now. The others sleep on.
void Workers::Board::finish() {
  state &= ~kOpen;
  for (const auto latest = Clock::now() + kPatience; state != 0 && Clock::now() < latest;) {
  }
  if (state == 0) return;
  std::unique_lock<std::mutex> lock(mutex);
  caller_sleeps = true;
  left.wait(lock, [&] { return state == 0; });
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

/// Detached: in a forked child there would be nobody to join.
void Workers::start(int others) {
  if (board_ && process_ == getpid() && board_->hands >= others) return;
  quit();
  process_ = getpid();
  board_ = std::make_shared<Board>(others);
  for (int place = 1; place <= others; ++place) std::thread(serve, board_, place).detach();
}

void Workers::share(int count, int worth, const Loop& loop) {
  if (count <= 0) return;
  if (shares_all_) worth = 1;
  const int piece = (worth - 1) / kPieces + 1;
  const int others = std::clamp(count / worth, 1, static_cast<int>(threads_)) - 1;
  if (others > 0) {
    start(others);
    shareOut(count, piece, others, loop);
  } else {
    Part all;
    all.end = count;
    Job job{loop, piece, &all, 1, {}, {}};
    work(job, 0);
    if (job.error) std::rethrow_exception(job.error);
  }
}

void Workers::shareOut(int count, int piece, int others, const Loop& loop) {
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

/// Each thread begins with its own part, by its place among them.
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
