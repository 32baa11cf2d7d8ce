// SPDX-License-Identifier: Apache-2.0
//
// `<collision>` and `<visual>`: what touches and what is seen.
#pragma once

#include <optional>
#include <sdf/Element.hh>
#include <sdf/Types.hh>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// The shape in the `<geometry>` of a collision or a visual; nothing for `<empty>`.
/// Throws SdfError at a size that is not positive, and at a kind we can't build.
std::optional<Shape> readShape(const sdf::ElementPtr& owner);

/// Friction and restitution of a `<collision>`.
void readSurface(const sdf::ElementPtr& element, Collision* collision, sdf::Errors* warnings);

/// The colour of a `<visual>`.
void readMaterial(const sdf::ElementPtr& element, Visual* visual);

}  // namespace kiva
