// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace kiva::python {

/// Threads that do independent jobs together with who calls. Between calls they sleep and cost
/// nothing. In a forked child, where they are gone, others are started.
class Crew {
 public:
  /// `threads` with the caller among them; 0: as many as the machine has cores.
  explicit Crew(unsigned threads);
  ~Crew();

  /// job(0) … job(count - 1), in any order, and returns when all are over. If some throw, what the
  /// first of them threw is thrown then.
  void each(std::size_t count, const std::function<void(std::size_t)>& job);
  unsigned threads() const { return threads_; }

 private:
  struct Board;
  static void work(const std::shared_ptr<Board>& board);
  void start(std::size_t most);
  void quit();

  unsigned threads_;
  int process_ = 0;
  std::shared_ptr<Board> board_;
};

}  // namespace kiva::python
