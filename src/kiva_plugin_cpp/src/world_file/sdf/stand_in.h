// SPDX-License-Identifier: Apache-2.0
//
// Stand-ins for parts that can't be loaded, which must never count as free floor.
#pragma once

#include <string>

#include "world_file/files/errors.h"
#include "world_file/sdf/shapes.h"

namespace kiva {

/// The model that stands in for an included model that is missing.
constexpr char kUnknownObstacle[] = "model://unknown_obstacle";
/// The end of a warning about such an include.
constexpr char kStandsIn[] = "; a box of 1 m by 1 m stands in for it, where nothing drives";
/// Returns the name of an include's model without a `<name>`: the last part of its uri.
std::string nameIn(const std::string& uri);

/// Adds to `link`, which was made of `from`, a stand-in for `lost`, a collision whose shape is not
/// available. It is the link's visuals at that place, else any of its visuals; for a heightmap, the
/// box around it; else, in a static model, a box of 1 m by 1 m from 2 m below its place to 1 m
/// above. `cause` goes into the warning.
void addStandIn(const XmlElement& from, const XmlElement& collision, const Collision& lost,
                const SdfError& cause, const Origin& origin, bool is_static, Link* link,
                Faults* warnings);

/// Adds a cube of 1 m at the origin of a movable model that lost all of its collisions and would
/// fall through the floor.
void addStandIn(const XmlElement& from, ModelDescription* description, Faults* warnings);

}  // namespace kiva
