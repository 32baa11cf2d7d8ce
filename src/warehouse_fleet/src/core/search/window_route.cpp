// SPDX-License-Identifier: Apache-2.0
#include "core/search/window_route.h"

#include <algorithm>

namespace fleet {
namespace {

constexpr int kMostDetour = 64 * kTickCost;  // largest cost above the least one

}  // namespace

WindowRoute::WindowRoute(const Floor& floor, const Candidates& candidates, const WindowPaths& paths)
    : floor_(floor),
      candidates_(candidates),
      paths_(paths),
      side_(2 * paths.ticks() + 1),
      queues_(kMostDetour + 1),
      visited_by_(static_cast<std::size_t>(side_) * side_ * (paths.ticks() + 1) * kHeadings * 2) {}

bool WindowRoute::find(int robot, const Wish& wish, int most, bool among_others, WindowPath& path) {
  robot_ = robot;
  wish_ = &wish;
  among_others_ = among_others;
  nodes_.clear();
  for (int i = 0; i < used_; ++i) queues_[i].clear();
  used_ = 0;
  ++search_;
  const bool has_arrived = wish.goal == kNowhere || wish.goal == wish.state.cell;
  first_ = has_arrived ? 0 : candidates_.distance(wish, wish.state);
  most_ = std::min(most, first_ + kMostDetour);
  push(-1, wish.state, has_arrived);
  for (int above = 0; above < used_; ++above) {
    while (!queues_[above].empty()) {
      const int index = queues_[above].back();
      queues_[above].pop_back();
      if (!isNew(nodes_[index])) continue;
      if (nodes_[index].tick == paths_.ticks()) {
        trace(index, path);
        return true;
      }
      expand(index);
    }
  }
  return false;
}

/// Pushes turns first: of equal states the last one pushed, a drive, is expanded first.
void WindowRoute::expand(int index) {
  const Node node = nodes_[index];
  const auto [cell, heading] = node.state;
  const bool stands = node.has_arrived && wish_->stops_at_goal && wish_->goal != kNowhere;
  const bool may_stay = mayEnter(node, cell);
  if (may_stay && !stands && candidates_.mayTurn(*wish_, cell)) {
    push(index, {cell, static_cast<Heading>(turned(heading, -1))}, node.has_arrived);
    push(index, {cell, static_cast<Heading>(turned(heading, 1))}, node.has_arrived);
  }
  if (may_stay) push(index, node.state, node.has_arrived);
  const Cell to = stands ? kNowhere : candidates_.next(*wish_, cell, heading);
  if (to == kNowhere || !mayEnter(node, to)) return;
  const bool arrives = to == wish_->goal;
  if (arrives && wish_->stops_at_goal) push(index, {to, heading}, node.has_arrived);
  push(index, {to, heading}, node.has_arrived || arrives);
}

bool WindowRoute::mayEnter(const Node& from, Cell to) const {
  return !among_others_ ||
         paths_.blocker(robot_, from.state.cell, to, from.tick) == WindowPaths::kNobody;
}

void WindowRoute::push(int parent, GridPose state, bool has_arrived) {
  Node node{state, parent, 0, 0, 0, has_arrived};
  if (!has_arrived) node.left = candidates_.distance(*wish_, state);
  if (parent >= 0) {
    const Node& before = nodes_[parent];
    node.tick = static_cast<std::int16_t>(before.tick + 1);
    // Driving costs as much as it brings the robot nearer, so that waiting before an expensive edge
    // gains nothing. Having arrived costs nothing; moving at the goal costs little.
    const bool stands = state == before.state;
    const int least = before.has_arrived ? static_cast<int>(!stands) : kTickCost;
    node.cost = before.cost + std::max(least, before.left - node.left);
  }
  const int total = node.cost + node.left;
  if (node.left >= kUnreachable || total > most_) return;
  const int above = std::max(0, total - first_);
  nodes_.push_back(node);
  queues_[above].push_back(static_cast<int>(nodes_.size()) - 1);
  used_ = std::max(used_, above + 1);
}

bool WindowRoute::isNew(const Node& node) {
  const int x = floor_.x(node.state.cell) - floor_.x(wish_->state.cell) + paths_.ticks();
  const int y = floor_.y(node.state.cell) - floor_.y(wish_->state.cell) + paths_.ticks();
  const int place = (y * side_ + x) * (paths_.ticks() + 1) + node.tick;
  const int index = (place * kHeadings + node.state.heading) * 2 + (node.has_arrived ? 1 : 0);
  return std::exchange(visited_by_[index], search_) != search_;
}

void WindowRoute::trace(int index, WindowPath& path) const {
  path.cost = nodes_[index].cost + nodes_[index].left;
  for (; index >= 0; index = nodes_[index].parent) {
    path.states[nodes_[index].tick] = nodes_[index].state;
  }
}

}  // namespace fleet
