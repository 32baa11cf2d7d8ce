// SPDX-License-Identifier: Apache-2.0
//
// RWARE's warehouse: its rules, bit by bit.
#pragma once

#include <memory>
#include <vector>

#include "rware/arbiter.h"
#include "rware/layout.h"
#include "rware/numpy_generator.h"

namespace rware {

// The actions, numbered as in RWARE.
enum Action : int { kNoop, kForward, kLeft, kRight, kToggleLoad };
enum Direction : int { kUp, kDown, kToLeft, kToRight };
enum class Reward : int { kGlobal, kIndividual, kTwoStage };
constexpr int kActions = 5, kDirections = 4;

struct Options {
  int agents = 2;
  int requests = 2;        ///< Number of requested shelves.
  int max_inactivity = 0;  ///< Steps without a delivery after which an episode ends; 0: unlimited.
  int max_steps = 500;     ///< Steps after which an episode ends; 0: unlimited.
  Reward reward = Reward::kIndividual;
};

struct Agent {
  int cell = 0;
  int direction = kUp;
  int shelf = -1;  ///< Carried shelf, an index into Layout::storage; -1 = none.
  bool has_delivered = false;
};

class Warehouse {
 public:
  Warehouse(std::shared_ptr<const Layout> layout, const Options& options);

  void seed(const NumpyGenerator::State& state) { random_ = NumpyGenerator(state); }
  const NumpyGenerator::State& stream() const { return random_.state(); }

  /// Begins an episode with the next numbers of the random stream.
  void reset();
  /// `actions`: one an agent; `rewards`: written, one an agent. Returns whether the episode ends.
  bool step(const std::int8_t* actions, double* rewards);

  const Layout& layout() const { return *layout_; }
  const std::vector<Agent>& agents() const { return agents_; }
  int agentAt(int cell) const { return agent_at_[cell]; }  ///< -1 = none.
  int shelfAt(int cell) const { return shelf_at_[cell]; }  ///< -1 = none.
  bool isRequested(int shelf) const { return requested_[shelf]; }
  const std::vector<int>& requests() const { return requests_; }  ///< Requested shelves.
  int shelfCell(int shelf) const { return shelf_cell_[shelf]; }
  /// Returns the cell ahead of an agent; its own at the edge of the floor, and before a wall.
  int ahead(const Agent& agent) const;

 private:
  int beyond(const Agent& agent) const;
  MoveWish wish(const Agent& agent, int action) const;
  void turn(Agent* agent, int action) const;
  void toggleLoad(Agent* agent, double* reward) const;
  void move(const std::vector<char>& committed);
  bool deliver(double* rewards);
  void payFor(int cell, double* rewards);
  int drawRequest();

  std::shared_ptr<const Layout> layout_;
  Options options_;
  NumpyGenerator random_;
  Arbiter arbiter_;
  std::vector<Agent> agents_;
  std::vector<int> agent_at_, shelf_at_;  // by cell
  std::vector<int> shelf_cell_;
  std::vector<char> requested_;  // by shelf
  std::vector<int> requests_;
  std::vector<MoveWish> wishes_;
  int steps_ = 0, inactive_ = 0;
};

}  // namespace rware
