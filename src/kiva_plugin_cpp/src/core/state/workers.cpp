// SPDX-License-Identifier: Apache-2.0
#include "core/state/workers.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace kiva {

struct Workers::Job {
  const Loop& loop;
  const int count, block;
  std::atomic<int> next{0};
  std::mutex mutex;  // of the error
  std::exception_ptr error = nullptr;
};

/// What the threads read; it lives until the last of them has left.
struct Workers::Board {
  std::mutex mutex;
  std::condition_variable posted, left;
  Job* job = nullptr;  // that others may take part in
  int at_job = 0;      // who do
  int hands = 0;       // threads beside the caller
  bool quits = false;
};

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
  board_ = std::make_shared<Board>();
  for (; board_->hands < others; ++board_->hands) std::thread(serve, board_).detach();
}

void Workers::share(int count, int block, const Loop& loop) {
  if (count <= 0) return;
  if (shares_all_) block = 1;
  Job job{loop, count, block, {}, {}, {}};
  const int others = std::min((count - 1) / block, static_cast<int>(threads_) - 1);
  if (others == 0) {
    work(job);
  } else {
    start(others);
    Board& board = *board_;
    {
      const std::lock_guard<std::mutex> lock(board.mutex);
      board.job = &job;
    }
    for (int i = 0; i < others; ++i) board.posted.notify_one();
    work(job);
    // Who has not woken by now sleeps on: only those that took the job are waited for.
    std::unique_lock<std::mutex> lock(board.mutex);
    board.job = nullptr;
    board.left.wait(lock, [&] { return board.at_job == 0; });
  }
  if (job.error) std::rethrow_exception(job.error);
}

void Workers::serve(const std::shared_ptr<Board>& board) {
  std::unique_lock<std::mutex> lock(board->mutex);
  while (true) {
    board->posted.wait(lock, [&] { return board->quits || board->job; });
    if (board->quits) return;
    Job& job = *board->job;
    ++board->at_job;
    lock.unlock();
    work(job);
    lock.lock();
    if (board->job == &job) board->job = nullptr;  // nothing of it is left to take
    if (--board->at_job == 0) board->left.notify_one();
  }
}

void Workers::work(Job& job) {
  for (int begin; (begin = job.next.fetch_add(job.block)) < job.count;) {
    try {
      job.loop(begin, std::min(begin + job.block, job.count));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(job.mutex);
      if (!job.error) job.error = std::current_exception();
    }
  }
}

}  // namespace kiva
