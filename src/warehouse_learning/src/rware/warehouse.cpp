// SPDX-License-Identifier: Apache-2.0
#include "rware/warehouse.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace rware {
namespace {

constexpr std::array<int, kDirections> kClockwise{kUp, kToRight, kDown, kToLeft};

}  // namespace

Warehouse::Warehouse(std::shared_ptr<const Layout> layout, const Options& options)
    : layout_(std::move(layout)),
      options_(options),
      arbiter_(*layout_),
      agents_(options.agents),
      agent_at_(layout_->size(), -1),
      shelf_at_(layout_->size(), -1),
      wishes_(options.agents) {
  if (options.agents < 1 || options.agents > static_cast<int>(layout_->open.size())) {
    throw std::invalid_argument("agents is " + std::to_string(options.agents) +
                                "; expected 1 to the number of cells");
  }
  if (options.requests < 0 || options.requests > static_cast<int>(layout_->storage.size())) {
    throw std::invalid_argument("request_queue_size is " + std::to_string(options.requests) +
                                "; expected 0 to the number of shelves");
  }
}

void Warehouse::reset() {
  steps_ = inactive_ = 0;
  std::fill(agent_at_.begin(), agent_at_.end(), -1);
  std::fill(shelf_at_.begin(), shelf_at_.end(), -1);
  shelf_cell_ = layout_->storage;
  for (std::size_t shelf = 0; shelf < shelf_cell_.size(); ++shelf) {
    shelf_at_[shelf_cell_[shelf]] = static_cast<int>(shelf);
  }
  const auto open = static_cast<int>(layout_->open.size());
  const std::vector<int> drawn = random_.choice(open, options_.agents);
  for (int i = 0; i < options_.agents; ++i) {
    const int cell = layout_->open[drawn[i]];
    agents_[i] = Agent{cell, random_.integer(kDirections)};
    agent_at_[cell] = i;
  }
  requests_ = random_.choice(static_cast<int>(shelf_cell_.size()), options_.requests);
  requested_.assign(shelf_cell_.size(), false);
  for (const int shelf : requests_) requested_[shelf] = true;
}

bool Warehouse::step(const std::int8_t* actions, double* rewards) {
  for (std::size_t i = 0; i < agents_.size(); ++i) wishes_[i] = wish(agents_[i], actions[i]);
  const std::vector<char>& committed = arbiter_.settle(wishes_, agent_at_);
  std::fill(rewards, rewards + agents_.size(), 0.0);
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    turn(&agents_[i], actions[i]);
    if (actions[i] == kToggleLoad) toggleLoad(&agents_[i], &rewards[i]);
  }
  move(committed);
  inactive_ = deliver(rewards) ? 0 : inactive_ + 1;
  ++steps_;
  return (options_.max_inactivity && inactive_ >= options_.max_inactivity) ||
         (options_.max_steps && steps_ >= options_.max_steps);
}

int Warehouse::ahead(const Agent& agent) const {
  const int to = beyond(agent);
  return layout_->isWall(to) ? agent.cell : to;
}

int Warehouse::beyond(const Agent& agent) const {
  const int x = layout_->x(agent.cell), y = layout_->y(agent.cell);
  switch (agent.direction) {
    case kUp:
      return y > 0 ? agent.cell - layout_->width : agent.cell;
    case kDown:
      return y + 1 < layout_->height ? agent.cell + layout_->width : agent.cell;
    case kToLeft:
      return x > 0 ? agent.cell - 1 : agent.cell;
    default:
      return x + 1 < layout_->width ? agent.cell + 1 : agent.cell;
  }
}

MoveWish Warehouse::wish(const Agent& agent, int action) const {
  if (action != kForward) return {agent.cell, agent.cell};
  const int target = ahead(agent);
  const int other = agent_at_[target];
  // Cancels a loaded agent's move into a cell whose shelf stands on the floor.
  const bool stands = shelf_at_[target] >= 0 && !(other >= 0 && agents_[other].shelf >= 0);
  return {agent.cell, agent.shelf >= 0 && stands ? agent.cell : target};
}

void Warehouse::turn(Agent* agent, int action) const {
  if (action != kLeft && action != kRight) return;
  const auto now = std::find(kClockwise.begin(), kClockwise.end(), agent->direction);
  const auto by = static_cast<std::size_t>(action == kRight ? 1 : kDirections - 1);
  agent->direction = kClockwise[(now - kClockwise.begin() + by) % kDirections];
}

void Warehouse::toggleLoad(Agent* agent, double* reward) const {
  if (agent->shelf < 0) {
    agent->shelf = shelf_at_[agent->cell];
  } else if (!layout_->highway[agent->cell]) {
    agent->shelf = -1;
    if (agent->has_delivered && options_.reward == Reward::kTwoStage) *reward += 0.5;
    agent->has_delivered = false;
  }
}

void Warehouse::move(const std::vector<char>& committed) {
  // All leave before any arrives: in a ring each takes the place of another.
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    if (!committed[i] || wishes_[i].to == wishes_[i].from) continue;
    agent_at_[wishes_[i].from] = -1;
    if (agents_[i].shelf >= 0) shelf_at_[wishes_[i].from] = -1;
  }
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    if (!committed[i] || wishes_[i].to == wishes_[i].from) continue;
    Agent& agent = agents_[i];
    agent.cell = wishes_[i].to;
    agent_at_[agent.cell] = static_cast<int>(i);
    if (agent.shelf < 0) continue;
    shelf_at_[agent.cell] = agent.shelf;
    shelf_cell_[agent.shelf] = agent.cell;
  }
}

bool Warehouse::deliver(double* rewards) {
  bool delivered = false;
  for (const int goal : layout_->goals) {
    const int shelf = shelf_at_[goal];
    if (shelf < 0 || !requested_[shelf]) continue;
    delivered = true;
    const int fresh = drawRequest();
    *std::find(requests_.begin(), requests_.end(), shelf) = fresh;
    requested_[shelf] = false;
    requested_[fresh] = true;
    payFor(goal, rewards);
  }
  return delivered;
}

/// Draws one of the shelves that are not requested.
int Warehouse::drawRequest() {
  const auto count = static_cast<int>(shelf_cell_.size()) - options_.requests;
  if (count < 1) throw std::invalid_argument("every shelf is requested; none is left to draw");
  int index = random_.integer(count);
  for (int shelf = 0;; ++shelf) {
    if (!requested_[shelf] && index-- == 0) return shelf;
  }
}

void Warehouse::payFor(int cell, double* rewards) {
  if (options_.reward == Reward::kGlobal) {
    for (std::size_t i = 0; i < agents_.size(); ++i) rewards[i] += 1;
    return;
  }
  const int agent = agent_at_[cell];
  if (options_.reward == Reward::kIndividual) {
    rewards[agent] += 1;
  } else {
    agents_[agent].has_delivered = true;
    rewards[agent] += 0.5;
  }
}

}  // namespace rware
