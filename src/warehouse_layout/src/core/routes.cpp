// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/routes.h"

#include <algorithm>
#include <limits>

namespace layout {
namespace {

struct Arrival {
  double seconds;
  std::int32_t node;
};

/// A queue whose nodes arrive in the order of time: each is reached from a node that left a queue
/// in that order, at the same cost. So two queues replace the heap that edges of any cost would
/// need.
struct Queue {
  std::vector<Arrival> nodes;
  std::size_t first = 0;

  bool empty() const { return first == nodes.size(); }
  double next() const {
    return empty() ? std::numeric_limits<double>::infinity() : nodes[first].seconds;
  }
};

class RouteSearch {
 public:
  RouteSearch(const RouteGraph& graph, Cell start, bool keeps_before, Routes* out)
      : graph_(graph), start_(start), keeps_before_(keeps_before), out_(*out) {
    const std::size_t nodes = static_cast<std::size_t>(graph.cells) * kHeadings;
    out_.seconds.assign(nodes, std::numeric_limits<double>::infinity());
    out_.steps.assign(nodes, 0);
    if (keeps_before) out_.before.assign(nodes, -1);
  }

  void run() {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const std::int32_t node = start_ * kHeadings + heading;
      out_.seconds[node] = 0;
      turns_.nodes.push_back({0, node});
    }
    while (!steps_.empty() || !turns_.empty()) {
      const bool has_turned = turns_.next() < steps_.next();
      Queue& queue = has_turned ? turns_ : steps_;
      const Arrival reached = queue.nodes[queue.first++];
      if (reached.seconds <= out_.seconds[reached.node]) goOn(reached, has_turned);
    }
  }

 private:
  /// A robot never turns twice in a cell: it would go back.
  void goOn(Arrival reached, bool has_turned) {
    stepOn(reached);
    if (has_turned) return;
    const Cell cell = reached.node / kHeadings;
    for (const int quarters : {1, kHeadings - 1}) {
      const int node = cell * kHeadings + (reached.node + quarters) % kHeadings;
      const Cell next = graph_.next[node];
      if (next == kNowhere || !reach(reached, node, graph_.turn, 0)) continue;
      const Arrival turned{out_.seconds[node], node};
      // Most arrivals turn into an end, which need not wait in the queue.
      graph_.end[next] ? stepOn(turned) : turns_.nodes.push_back(turned);
    }
  }

  void stepOn(Arrival reached) {
    const Cell next = graph_.next[reached.node];
    if (next == kNowhere) return;
    const std::int32_t node = next * kHeadings + reached.node % kHeadings;
    if (!reach(reached, node, graph_.step, 1) || graph_.end[next]) return;
    steps_.nodes.push_back({out_.seconds[node], node});
  }

  bool reach(Arrival from, std::int32_t node, double cost, int steps) {
    const double seconds = from.seconds + cost;
    if (seconds >= out_.seconds[node]) return false;
    out_.seconds[node] = seconds;
    out_.steps[node] = out_.steps[from.node] + steps;
    if (keeps_before_) out_.before[node] = from.node;
    return true;
  }

  const RouteGraph& graph_;
  Cell start_;
  bool keeps_before_;
  Routes& out_;
  Queue steps_, turns_;
};

}  // namespace

Routes routesFrom(const RouteGraph& graph, Cell start) {
  Routes out;
  RouteSearch(graph, start, true, &out).run();
  return out;
}

Ways waysFrom(const RouteGraph& graph, Cell start, const std::vector<Cell>& ends) {
  // Kept between calls: on a large floor fresh memory takes as long as the search.
  thread_local Routes all;
  RouteSearch(graph, start, false, &all).run();
  Ways out;
  out.seconds.reserve(ends.size());
  out.steps.reserve(ends.size());
  for (const Cell end : ends) {
    const auto first = all.seconds.begin() + static_cast<std::ptrdiff_t>(end) * kHeadings;
    const auto first_reached = std::min_element(first, first + kHeadings);
    out.seconds.push_back(*first_reached);
    out.steps.push_back(all.steps[first_reached - all.seconds.begin()]);
  }
  return out;
}

}  // namespace layout
