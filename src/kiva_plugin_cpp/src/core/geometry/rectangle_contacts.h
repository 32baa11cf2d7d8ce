// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kiva {

/// A rectangle on the floor, rotated by (c, s). In world [m].
struct Rectangle {
  double x = 0, y = 0;
  double c = 1, s = 0;
  double hx = 0, hy = 0;
};

/// A point where two outlines touch, or may touch soon.
struct OutlineContact {
  double x = 0, y = 0;    ///< Position on the second one, in world [m].
  double nx = 0, ny = 0;  ///< Unit normal, from the second to the first.
  double distance = 0;    ///< Distance along the normal [m]; negative where they overlap.
};

struct OutlineContacts {
  int count = 0;
  std::array<OutlineContact, 2> at;
};

/// Returns the contacts of two rectangles within `reach` [m]: both ends of the stretch along which
/// their sides face each other, or their two nearest corners.
OutlineContacts findContacts(const Rectangle& a, const Rectangle& b, double reach);

/// Returns whether a quick test shows that they are farther apart than `distance` [m].
bool areFarther(double distance, const Rectangle& a, const Rectangle& b);

}  // namespace kiva
