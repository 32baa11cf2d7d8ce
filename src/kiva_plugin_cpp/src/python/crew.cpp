// SPDX-License-Identifier: Apache-2.0
#include "crew.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace kiva::python {

/// What the threads read; it outlives the Crew until the last of them has left.
struct Crew::Board {
  std::mutex mutex;
  std::condition_variable news, over;
  const std::function<void(std::size_t)>* job = nullptr;
  std::size_t count = 0, round = 0, hands = 0, busy = 0;
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  bool quits = false;

  void take() {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        (*job)(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!error) error = std::current_exception();
      }
    }
  }
};

Crew::Crew(unsigned threads)
    : threads_(threads ? threads : std::max(1u, std::thread::hardware_concurrency())) {}

Crew::~Crew() { quit(); }

void Crew::quit() {
  if (!board_ || process_ != getpid()) return;
  {
    const std::lock_guard<std::mutex> lock(board_->mutex);
    board_->quits = true;
  }
  board_->news.notify_all();
}

void Crew::work(const std::shared_ptr<Board>& board) {
  std::size_t seen = 0;
  std::unique_lock<std::mutex> lock(board->mutex);
  while (true) {
    board->news.wait(lock, [&] { return board->quits || board->round != seen; });
    if (board->quits) return;
    seen = board->round;
    lock.unlock();
    board->take();
    lock.lock();
    if (--board->busy == 0) board->over.notify_one();
  }
}

void Crew::start(std::size_t most) {
  const std::size_t wanted = std::min<std::size_t>(threads_, most) - 1;
  if (process_ != getpid() || board_->hands < wanted) {
    quit();
    process_ = getpid();
    board_ = std::make_shared<Board>();
    for (; board_->hands < wanted; ++board_->hands) std::thread(work, board_).detach();
  }
}

void Crew::each(std::size_t count, const std::function<void(std::size_t)>& job) {
  if (count == 0) return;
  if (count == 1) return job(0);
  start(count);
  Board& board = *board_;
  {
    const std::lock_guard<std::mutex> lock(board.mutex);
    board.job = &job;
    board.count = count;
    board.next = 0;
    board.busy = board.hands;
    board.error = nullptr;
    ++board.round;
  }
  board.news.notify_all();
  board.take();
  std::unique_lock<std::mutex> lock(board.mutex);
  board.over.wait(lock, [&] { return board.busy == 0; });
  if (board.error) std::rethrow_exception(board.error);
}

}  // namespace kiva::python
