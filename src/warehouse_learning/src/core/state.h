// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "table.h"

namespace learning {

constexpr int kNone = -1;

/// The task in many warehouses at once: a row a warehouse, a column a robot, a unit or a cell.
struct TaskState {
  TaskState(int warehouses, int robots, int units, int cells)
      : cell(warehouses, robots),
        heading(warehouses, robots),
        busy(warehouses, robots),
        load(warehouses, robots, kNone),
        bound_for(warehouses, robots),
        turning(warehouses, robots),
        unit_cell(warehouses, units),
        unit_at(warehouses, cells, kNone),
        requested(warehouses, units),
        served(warehouses, units) {}

  int warehouses() const { return cell.rows(); }
  int robots() const { return cell.columns(); }
  int units() const { return unit_cell.columns(); }

  // Columns are robots.
  Table<std::int32_t> cell;
  Table<std::int8_t> heading;
  Table<bool> busy;               ///< An action is under way.
  Table<std::int32_t> load;       ///< The carried unit, kNone = none.
  Table<std::int32_t> bound_for;  ///< The cell that it drives to, else its own.
  Table<bool> turning;
  // Columns are storage units.
  Table<std::int32_t> unit_cell;  ///< kNone = carried.
  Table<std::int32_t> unit_at;    ///< By cell: the unit there, kNone = none.
  Table<bool> requested;
  Table<bool> served;  ///< The unit was delivered and not yet put back.
};

}  // namespace learning
