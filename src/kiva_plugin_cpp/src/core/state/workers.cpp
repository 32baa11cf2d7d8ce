// SPDX-License-Identifier: Apache-2.0
#include "core/state/workers.h"

#include <algorithm>

namespace kiva {

struct Workers::Job {
  const std::function<void(int, int)>& loop;
  const int count, block;
  std::atomic<int> next{0};
};

Workers::Workers(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { serve(); });
}

Workers::~Workers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  posted_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::share(int count, int block, const std::function<void(int, int)>& loop) {
  if (count <= 0) return;
  if (shares_all_) block = 1;
  if (threads_.empty() || count <= block) return loop(0, count);
  Job job{loop, count, block};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    job_ = &job;
  }
  const int others = std::min((count - 1) / block, static_cast<int>(threads_.size()));
  for (int i = 0; i < others; ++i) posted_.notify_one();
  work(job);
  // Who has not woken by now sleeps on: only those that took the job are waited for.
  std::unique_lock<std::mutex> lock(mutex_);
  job_ = nullptr;
  left_.wait(lock, [this] { return at_job_ == 0; });
}

void Workers::serve() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    posted_.wait(lock, [this] { return ends_ || job_; });
    if (ends_) return;
    Job& job = *job_;
    ++at_job_;
    lock.unlock();
    work(job);
    lock.lock();
    if (job_ == &job) job_ = nullptr;  // nothing of it is left to take
    if (--at_job_ == 0) left_.notify_one();
  }
}

void Workers::work(Job& job) {
  for (int begin; (begin = job.next.fetch_add(job.block)) < job.count;) {
    job.loop(begin, std::min(begin + job.block, job.count));
  }
}

}  // namespace kiva
