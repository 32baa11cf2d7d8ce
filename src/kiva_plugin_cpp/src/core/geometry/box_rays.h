// SPDX-License-Identifier: Apache-2.0
//
// Rays of a fan against one box, several at a time. Every variant rounds alike, so that a world's
// states do not depend on its processor.
#pragma once

#include <cstdint>

namespace kiva {

/// A box relative to the laser, which is at (0, 0).
struct BoxTarget {
  double x = 0, y = 0;    ///< Its centre [m].
  double c = 1, s = 0;    ///< Cosine and sine of its heading.
  double hx = 0, hy = 0;  ///< Half its sides [m].
  std::int64_t model = -1;
};

/// Adjacent rays of a fan, and the nearest hit of each so far.
struct RayPacket {
  const double *c = nullptr, *s = nullptr;  ///< Directions, as cosine and sine.
  int rays = 0;
  double* range = nullptr;        ///< [m]
  std::int64_t* model = nullptr;  ///< -1 = none.
};

/// The instructions of a variant.
enum class Simd {
  kNone,      ///< A ray at a time: the others are tested against it.
  kBaseline,  ///< What every processor of the architecture has: SSE2 on amd64, NEON on arm64.
  kAvx2
};

bool isSupported(Simd simd);

/// Casts the rays at the box: a hit counts if it is nearer than the ray's present one, or as near
/// and of a lower model.
using CastAtBox = void (*)(const BoxTarget& box, const RayPacket& rays);
CastAtBox castAtBox(Simd simd);
/// Returns the fastest variant that the processor supports.
CastAtBox castAtBox();

}  // namespace kiva
