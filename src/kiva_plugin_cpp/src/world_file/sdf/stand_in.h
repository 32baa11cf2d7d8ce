// SPDX-License-Identifier: Apache-2.0
//
// What can't be loaded is never free floor: something stands in its place.
#pragma once

#include <string>

#include "world_file/files/errors.h"
#include "world_file/sdf/shapes.h"

namespace kiva {

/// The model that stands in for one that an include names and that can't be had.
constexpr char kUnknownObstacle[] = "model://unknown_obstacle";
/// What a warning of such an include ends with.
constexpr char kStandsIn[] = "; a box of 1 m by 1 m stands in for it, where nothing drives";
/// What its model is called if the include does not say: the last part of its uri.
std::string nameIn(const std::string& uri);

/// Adds to `link`, which was made of `from`, what stands in for `lost`, a collision of it whose
/// shape can't be had: the link's visuals at that place, else any of its visuals; for a heightmap
/// the box around it; else, in a static model, a box of 1 m by 1 m from 2 m below its place to 1 m
/// above. `cause` is why, for the warning that says what was done.
void addStandIn(const XmlElement& from, const XmlElement& collision, const Collision& lost,
                const SdfError& cause, const Origin& origin, bool is_static, Link* link,
                Faults* warnings);

/// Without any of its collisions a model that moves would fall through the floor: a cube of 1 m on
/// its origin stands in for them.
void addStandIn(const XmlElement& from, ModelDescription* description, Faults* warnings);

}  // namespace kiva
