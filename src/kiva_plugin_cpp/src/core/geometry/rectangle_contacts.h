// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kiva {

/// On the floor, turned by (c, s). In world [m].
struct Rectangle {
  double x = 0, y = 0;
  double c = 1, s = 0;
  double hx = 0, hy = 0;
};

/// Where two outlines touch, or may touch soon.
struct OutlineContact {
  double x = 0, y = 0;    ///< On the second one, in world [m].
  double nx = 0, ny = 0;  ///< Unit normal, from the second to the first.
  double distance = 0;    ///< Along it [m]; negative where they overlap.
};

struct OutlineContacts {
  int count = 0;
  std::array<OutlineContact, 2> at;
};

/// Returns where two rectangles are no farther apart than `reach` [m]: both ends of the stretch
/// along which a side of the one faces a side of the other, or the two corners that are nearest.
OutlineContacts findContacts(const Rectangle& a, const Rectangle& b, double reach);

/// Returns whether they are seen to be farther apart than that [m], at a glance.
bool areFarther(double distance, const Rectangle& a, const Rectangle& b);

}  // namespace kiva
