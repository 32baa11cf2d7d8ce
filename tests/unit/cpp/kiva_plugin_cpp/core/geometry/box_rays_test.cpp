// SPDX-License-Identifier: Apache-2.0
//
// Rays at boxes: each variant of instructions gives the same bits, whatever it is asked.
#include "core/geometry/box_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace kiva {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kScenes = 2000, kMostRays = 37, kBoxes = 6;

/// The nearest hits of a fan's rays, by one variant of instructions.
struct Hits {
  std::vector<double> range;
  std::vector<std::int64_t> model;
};

struct Rays {
  std::vector<double> c, s;
  double reach = 5;

  void add(double angle) {
    c.push_back(std::cos(angle));
    s.push_back(std::sin(angle));
  }
  Hits castAt(const std::vector<BoxTarget>& boxes, Simd simd) const {
    const std::size_t count = c.size();
    Hits hits{std::vector<double>(count, reach), std::vector<std::int64_t>(count, -1)};
    const CastAtBox cast = castAtBox(simd);
    for (const BoxTarget& box : boxes) {
      cast(box,
           {c.data(), s.data(), static_cast<int>(count), hits.range.data(), hits.model.data()});
    }
    return hits;
  }
};

/// Bits, not numbers: NaN equals itself, and 0 differs from -0.
std::vector<std::uint64_t> bitsOf(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits(numbers.size());
  std::memcpy(bits.data(), numbers.data(), numbers.size() * sizeof(double));
  return bits;
}

void expectEqual(const Rays& rays, const std::vector<BoxTarget>& boxes) {
  const Hits singly = rays.castAt(boxes, Simd::kNone);
  for (const Simd simd : {Simd::kBaseline, Simd::kAvx2}) {
    if (!isSupported(simd)) continue;
    const Hits together = rays.castAt(boxes, simd);
    EXPECT_EQ(bitsOf(together.range), bitsOf(singly.range));
    EXPECT_EQ(together.model, singly.model);
  }
}

class Scenes {
 public:
  double within(double most) {
    return std::uniform_real_distribution<double>(-most, most)(random_);
  }
  BoxTarget box(int model) {
    const double yaw = within(M_PI);
    return {within(4),           within(4),           std::cos(yaw), std::sin(yaw),
            std::abs(within(1)), std::abs(within(1)), model};
  }
  Rays rays() {
    Rays out;
    const int count = 1 + static_cast<int>(std::abs(within(kMostRays)));
    for (int k = 0; k < count; ++k) out.add(within(M_PI));
    return out;
  }

 private:
  std::mt19937 random_{7};
};

TEST(BoxRays, GiveTheSameBitsByAllInstructions) {
  Scenes scenes;
  int met = 0;
  for (int scene = 0; scene < kScenes; ++scene) {
    std::vector<BoxTarget> boxes;
    for (int model = kBoxes; model > 0; --model) boxes.push_back(scenes.box(model));
    const Rays rays = scenes.rays();
    expectEqual(rays, boxes);
    for (const auto model : rays.castAt(boxes, Simd::kNone).model) met += model >= 0;
  }
  EXPECT_GT(met, kScenes);
}

TEST(BoxRays, GiveTheSameBitsAtTheEdges) {
  Rays rays;
  for (int k = 0; k < 16; ++k) rays.add(k * M_PI / 8);
  rays.c.insert(rays.c.end(), {1, 0, -1, 0, 0, -0.0, kNaN, kInfinity, 1});
  rays.s.insert(rays.s.end(), {0, 1, 0, -1, 0, 0, 0, 0, kNaN});
  const double odd[] = {0, -0.0, 1, -1, 1e-300, 1e300, kInfinity, -kInfinity, kNaN};
  for (const double x : odd) {
    for (const double y : odd) {
      for (const double half : odd) {
        // Beside the laser, around it, with a face or a corner at it, without any length.
        expectEqual(rays, {{x, y, 1, 0, half, 1, 3}, {x, y, 0, 1, 1, half, 2}});
        expectEqual(rays, {{x, y, 0.6, 0.8, half, half, 3}, {x, y, 0.6, 0.8, half, half, 2}});
      }
    }
  }
}

TEST(BoxRays, MeetFacesFromOutsideAndInside) {
  Rays rays;
  rays.add(0);
  rays.add(M_PI);
  for (const Simd simd : {Simd::kNone, Simd::kBaseline, Simd::kAvx2}) {
    if (!isSupported(simd)) continue;
    const Hits outside = rays.castAt({{2, 0, 1, 0, 0.5, 0.5, 4}}, simd);
    EXPECT_DOUBLE_EQ(outside.range[0], 1.5);
    EXPECT_EQ(outside.model, (std::vector<std::int64_t>{4, -1}));
    const Hits inside = rays.castAt({{0.2, 0, 1, 0, 0.5, 0.5, 4}}, simd);
    EXPECT_DOUBLE_EQ(inside.range[0], 0.7);
    EXPECT_DOUBLE_EQ(inside.range[1], 0.3);
    // Of equally near ones the lower model counts, in either order.
    for (const std::int64_t first : {1, 2}) {
      const Hits both =
          rays.castAt({{2, 0, 1, 0, 0.5, 0.5, first}, {2, 0, 1, 0, 0.5, 0.5, 3 - first}}, simd);
      EXPECT_EQ(both.model[0], 1);
    }
  }
}

}  // namespace
}  // namespace kiva
