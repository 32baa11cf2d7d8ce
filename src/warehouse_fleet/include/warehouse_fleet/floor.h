// SPDX-License-Identifier: Apache-2.0
//
// The floor that a fleet drives on, in the fleet's own names.
#pragma once

#include "warehouse_layout/floor.h"

namespace fleet {

using layout::Cell;
using layout::Deck;
using layout::Floor;
using layout::FloorDescription;
using layout::FloorError;
using layout::Heading;
using layout::kHeadings;
using layout::kNowhere;
using layout::turned;

}  // namespace fleet
