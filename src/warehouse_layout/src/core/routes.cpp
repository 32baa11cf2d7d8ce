// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/routes.h"

#include <limits>
#include <utility>

namespace layout {
namespace {

struct Found {
  double seconds;
  std::int32_t node;
};

/// Nodes come in by rising time, since each is found from one that was taken out by rising time, at
/// the same cost. So two queues do what a heap does for edges of any cost.
struct Queue {
  std::vector<Found> found;
  std::size_t first = 0;

  bool empty() const { return first == found.size(); }
  double next() const {
    return empty() ? std::numeric_limits<double>::infinity() : found[first].seconds;
  }
};

class Search {
 public:
  Search(const RouteGraph& graph, Cell start) : graph_(graph), start_(start) {
    const std::size_t nodes = static_cast<std::size_t>(graph.cells) * kHeadings;
    out_.seconds.assign(nodes, std::numeric_limits<double>::infinity());
    out_.steps.assign(nodes, 0);
    out_.before.assign(nodes, -1);
  }

  Routes run() {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const std::int32_t node = start_ * kHeadings + heading;
      out_.seconds[node] = 0;
      steps_.found.push_back({0, node});
    }
    while (!steps_.empty() || !turns_.empty()) {
      Queue& queue = turns_.next() < steps_.next() ? turns_ : steps_;
      const Found found = queue.found[queue.first++];
      if (found.seconds <= out_.seconds[found.node]) goOn(found);
    }
    return std::move(out_);
  }

 private:
  void goOn(Found found) {
    const Cell cell = found.node / kHeadings;
    const int heading = found.node % kHeadings;
    for (const int quarters : {1, kHeadings - 1}) {
      const int turned = (heading + quarters) % kHeadings;
      reach(found, cell * kHeadings + turned, graph_.turn, 0, turns_);
    }
    const Cell next = graph_.next[found.node];
    if (next == kNowhere || (graph_.end[cell] && cell != start_)) return;
    reach(found, next * kHeadings + heading, graph_.step, 1, steps_);
  }

  void reach(Found from, std::int32_t node, double cost, int steps, Queue& queue) {
    const double seconds = from.seconds + cost;
    if (seconds >= out_.seconds[node]) return;
    out_.seconds[node] = seconds;
    out_.steps[node] = out_.steps[from.node] + steps;
    out_.before[node] = from.node;
    queue.found.push_back({seconds, node});
  }

  const RouteGraph& graph_;
  Cell start_;
  Routes out_;
  Queue steps_, turns_;
};

}  // namespace

Routes routesFrom(const RouteGraph& graph, Cell start) { return Search(graph, start).run(); }

}  // namespace layout
