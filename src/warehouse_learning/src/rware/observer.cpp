// SPDX-License-Identifier: Apache-2.0
#include "rware/observer.h"

#include <algorithm>
#include <utility>

namespace rware {
namespace {

float* writeDirection(int direction, float* out) {
  for (int i = 0; i < kDirections; ++i) *out++ = i == direction ? 1.0f : 0.0f;
  return out;
}

/// Writes a cell's agent: presence, direction, message. Without an agent its direction is up.
float* writeAgent(const Warehouse& warehouse, int bits, const float* messages, int agent,
                  float* out) {
  *out++ = agent >= 0 ? 1.0f : 0.0f;
  out = writeDirection(agent >= 0 ? warehouse.agents()[agent].direction : kUp, out);
  if (agent >= 0) return std::copy_n(messages + agent * bits, bits, out);
  return std::fill_n(out, bits, 0.0f);
}

float* writeShelf(const Warehouse& warehouse, int shelf, float* out) {
  *out++ = shelf >= 0 ? 1.0f : 0.0f;
  *out++ = shelf >= 0 && warehouse.isRequested(shelf) ? 1.0f : 0.0f;
  return out;
}

/// Returns the agent where RWARE looks for agents when it draws directions and loads: it swaps rows
/// and columns there.
int agentTransposed(const Warehouse& warehouse, int x, int y) {
  const Layout& layout = warehouse.layout();
  return y < layout.width && x < layout.height ? warehouse.agentAt(x * layout.width + y) : -1;
}

float valueOf(const Warehouse& warehouse, Layer layer, int x, int y) {
  const int cell = y * warehouse.layout().width + x;
  const int agent = layer == Layer::kAgentDirection || layer == Layer::kAgentLoad
                        ? agentTransposed(warehouse, x, y)
                        : warehouse.agentAt(cell);
  const int shelf = warehouse.shelfAt(cell);
  const auto& goals = warehouse.layout().goals;
  switch (layer) {
    case Layer::kShelves:
      return shelf >= 0;
    case Layer::kRequests:
      return shelf >= 0 && warehouse.isRequested(shelf);
    case Layer::kAgents:
      return agent >= 0;
    case Layer::kAgentDirection:
      return agent >= 0 ? static_cast<float>(warehouse.agents()[agent].direction + 1) : 0;
    case Layer::kAgentLoad:
      return agent >= 0 && warehouse.agents()[agent].shelf >= 0;
    case Layer::kGoals:
      return std::find(goals.begin(), goals.end(), cell) != goals.end();
    default:
      return agent < 0 && !warehouse.layout().isWall(cell);
  }
}

/// Returns the offset, in columns and rows, of an agent's view at (column, row) of its picture of
/// `last` + 1 columns, if ahead is up there.
std::pair<int, int> turned(int direction, int column, int row, int last) {
  switch (direction) {
    case kDown:
      return {last - column, last - row};
    case kToLeft:
      return {row, last - column};
    case kToRight:
      return {last - row, column};
    default:
      return {column, row};
  }
}

}  // namespace

void writeVector(const Warehouse& warehouse, const Senses& senses, const float* messages, int index,
                 float* out) {
  const Layout& layout = warehouse.layout();
  const Agent& agent = warehouse.agents()[index];
  const int x = layout.x(agent.cell), y = layout.y(agent.cell);
  // Computed in double as in Python, then rounded once.
  *out++ = static_cast<float>(senses.normalised ? x / (layout.width - 1.0) : x);
  *out++ = static_cast<float>(senses.normalised ? y / (layout.height - 1.0) : y);
  *out++ = agent.shelf >= 0 ? 1.0f : 0.0f;
  out = writeDirection(agent.direction, out);
  *out++ = layout.highway[agent.cell];
  for (int row = y - senses.range; row <= y + senses.range; ++row) {
    for (int column = x - senses.range; column <= x + senses.range; ++column) {
      const bool inside = row >= 0 && row < layout.height && column >= 0 && column < layout.width;
      const int cell = row * layout.width + column;
      out =
          writeAgent(warehouse, senses.bits, messages, inside ? warehouse.agentAt(cell) : -1, out);
      out = writeShelf(warehouse, inside ? warehouse.shelfAt(cell) : -1, out);
    }
  }
}

void writeImage(const Warehouse& warehouse, const Senses& senses, const std::vector<Layer>& layers,
                bool directional, int index, float* out) {
  const Layout& layout = warehouse.layout();
  const Agent& agent = warehouse.agents()[index];
  const int left = layout.x(agent.cell) - senses.range, top = layout.y(agent.cell) - senses.range;
  const int direction = directional ? agent.direction : kUp;
  for (const Layer layer : layers) {
    for (int row = 0; row < senses.width(); ++row) {
      for (int column = 0; column < senses.width(); ++column) {
        const auto [dx, dy] = turned(direction, column, row, senses.width() - 1);
        const int x = left + dx, y = top + dy;
        const bool inside = x >= 0 && x < layout.width && y >= 0 && y < layout.height;
        *out++ = inside ? valueOf(warehouse, layer, x, y) : 0.0f;
      }
    }
  }
}

void writeFeatures(const Warehouse& warehouse, int index, float* out) {
  const Agent& agent = warehouse.agents()[index];
  out = writeDirection(agent.direction, out);
  *out++ = warehouse.layout().highway[agent.cell];
  *out++ = agent.shelf >= 0 ? 1.0f : 0.0f;
}

}  // namespace rware
