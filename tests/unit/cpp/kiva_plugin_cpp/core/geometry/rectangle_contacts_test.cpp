// SPDX-License-Identifier: Apache-2.0
//
// Contacts of random outlines on the floor.
#include "core/geometry/rectangle_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace kiva {
namespace {

constexpr double kReach = 0.05;  // [m]
constexpr double kExact = 1e-9;  // [m]
constexpr int kPairs = 20000;

struct PlanePoint {
  double x, y;
};

std::array<PlanePoint, 4> corners(const Rectangle& r) {
  std::array<PlanePoint, 4> out;
  const double signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  for (int i = 0; i < 4; ++i) {
    const double x = signs[i][0] * r.hx, y = signs[i][1] * r.hy;
    out[i] = {r.x + r.c * x - r.s * y, r.y + r.s * x + r.c * y};
  }
  return out;
}

/// Returns the distance of a point from a rectangle; negative inside.
double distance(const Rectangle& r, const PlanePoint& p) {
  const double dx = p.x - r.x, dy = p.y - r.y;
  const double along = std::abs(r.c * dx + r.s * dy) - r.hx;
  const double across = std::abs(r.c * dy - r.s * dx) - r.hy;
  if (along < 0 || across < 0) return std::max(along, across);
  return std::hypot(along, across);
}

/// Returns the gap along the axes of `a`.
double apartAlong(const Rectangle& a, const Rectangle& b) {
  double most = -1e9;
  for (const auto& [nx, ny, half] : {std::array<double, 3>{a.c, a.s, a.hx}, {-a.s, a.c, a.hy}}) {
    double nearest = 1e9, farthest = -1e9;
    for (const PlanePoint& p : corners(b)) {
      const double at = (p.x - a.x) * nx + (p.y - a.y) * ny;
      nearest = std::min(nearest, at);
      farthest = std::max(farthest, at);
    }
    most = std::max({most, nearest - half, -half - farthest});
  }
  return most;
}

/// Returns the distance of two rectangles; where they overlap, minus the shortest separation.
double distance(const Rectangle& a, const Rectangle& b) {
  const double apart = std::max(apartAlong(a, b), apartAlong(b, a));
  if (apart <= 0) return apart;
  double least = 1e9;
  for (const PlanePoint& p : corners(a)) least = std::min(least, distance(b, p));
  for (const PlanePoint& p : corners(b)) least = std::min(least, distance(a, p));
  return least;
}

class RectangleContacts : public ::testing::Test {
 protected:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<>(from, to)(random_);
  }
  Rectangle any() {
    const bool is_square = uniform(0, 1) < 0.2;  // to the axes, as most in a warehouse are
    const double yaw = is_square ? 0 : uniform(-M_PI, M_PI);
    return {uniform(-0.5, 0.5), uniform(-0.5, 0.5), std::cos(yaw),
            std::sin(yaw),      uniform(0.02, 0.4), uniform(0.02, 0.4)};
  }

  std::mt19937 random_{1};
};

TEST_F(RectangleContacts, AreFoundWhereverOutlinesAreNear) {
  int count = 0;
  for (int i = 0; i < kPairs; ++i) {
    const Rectangle a = any(), b = any();
    const double apart = distance(a, b);
    if (std::abs(apart - kReach) < kExact) continue;
    const OutlineContacts contacts = findContacts(a, b, kReach);
    ASSERT_EQ(contacts.count > 0, apart < kReach) << i << ": " << apart;
    ASSERT_FALSE(apart < kReach && areFarther(kReach, a, b)) << i;
    count += contacts.count > 0;
  }
  EXPECT_GT(count, kPairs / 10);
  EXPECT_LT(count, kPairs * 9 / 10);
}

TEST_F(RectangleContacts, LieOnBothOutlinesWhileTheseAreApart) {
  for (int i = 0; i < kPairs; ++i) {
    const Rectangle a = any(), b = any();
    const double apart = distance(a, b);
    if (apart < kExact) continue;
    const OutlineContacts contacts = findContacts(a, b, kReach);
    for (int k = 0; k < contacts.count; ++k) {
      const OutlineContact& c = contacts.at[k];
      ASSERT_NEAR(std::hypot(c.nx, c.ny), 1, kExact) << i;
      ASSERT_NEAR(distance(b, PlanePoint{c.x, c.y}), 0, kExact) << i;
      ASSERT_NEAR(distance(a, PlanePoint{c.x + c.nx * c.distance, c.y + c.ny * c.distance}), 0,
                  kExact)
          << i;
      ASSERT_GE(c.distance, apart - kExact) << i;
    }
  }
}

TEST_F(RectangleContacts, LeadTheShortestWayOutOfAnOverlap) {
  int tried = 0;
  for (int i = 0; i < kPairs; ++i) {
    const Rectangle a = any(), b = any();
    const double apart = distance(a, b);
    if (apart > -kExact || apart < -0.02) continue;  // what a step may bring
    const OutlineContacts contacts = findContacts(a, b, kReach);
    ASSERT_GT(contacts.count, 0) << i;
    const OutlineContact* deepest = &contacts.at[0];
    if (contacts.count > 1 && contacts.at[1].distance < deepest->distance) {
      deepest = &contacts.at[1];
    }
    ASSERT_NEAR(deepest->distance, apart, kExact) << i;
    Rectangle out = a;
    out.x -= deepest->nx * deepest->distance;
    out.y -= deepest->ny * deepest->distance;
    ASSERT_NEAR(distance(out, b), 0, kExact) << i;
    ++tried;
  }
  EXPECT_GT(tried, kPairs / 50);
}

TEST_F(RectangleContacts, AreTheSameSeenFromTheOther) {
  for (int i = 0; i < kPairs; ++i) {
    const Rectangle a = any(), b = any();
    const OutlineContacts of_a = findContacts(a, b, kReach), of_b = findContacts(b, a, kReach);
    ASSERT_EQ(of_a.count, of_b.count) << i;
    double sum = 0, swapped = 0;
    for (int k = 0; k < of_a.count; ++k) {
      sum += of_a.at[k].distance;
      swapped += of_b.at[k].distance;
    }
    ASSERT_NEAR(sum, swapped, kExact) << i;
  }
}

}  // namespace
}  // namespace kiva
