// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/box_rays.h"

namespace kiva {
namespace {

/// The slab test (Kay and Kajiya 1986) in the box's own axes. Inlined into each variant, which
/// makes the loop of its own instructions. None of them fuses products and sums
/// (-ffp-contract=off), which would round otherwise.
inline __attribute__((always_inline)) void castPacket(const BoxTarget& box, const RayPacket& rays) {
  const double tc = box.c, ts = box.s, hx = box.hx, hy = box.hy;
  const double px = -(box.x * tc + box.y * ts), py = box.x * ts - box.y * tc;
  const std::int64_t own = box.model;
  const double *c = rays.c, *s = rays.s;
  double* range = rays.range;
  std::int64_t* model = rays.model;
  const int count = rays.rays;
#pragma GCC ivdep
  for (int k = 0; k < count; ++k) {
    const double vx = c[k] * tc + s[k] * ts, vy = s[k] * tc - c[k] * ts;
    const double ix = 1 / (vx == 0 ? 1e-300 : vx), iy = 1 / (vy == 0 ? 1e-300 : vy);
    const double x0 = (-hx - px) * ix, x1 = (hx - px) * ix;
    const double y0 = (-hy - py) * iy, y1 = (hy - py) * iy;
    const double in_x = x0 < x1 ? x0 : x1, out_x = x0 < x1 ? x1 : x0;
    const double in_y = y0 < y1 ? y0 : y1, out_y = y0 < y1 ? y1 : y0;
    const double enter = in_x > in_y ? in_x : in_y, leave = out_x < out_y ? out_x : out_y;
    const double met = enter >= 0 ? enter : leave;
    const bool is_met = (enter <= leave) & (leave >= 0);
    const bool is_first = (met < range[k]) | ((met == range[k]) & (own < model[k]));
    const bool counts = is_met & is_first;
    range[k] = counts ? met : range[k];
    model[k] = counts ? own : model[k];
  }
}

void castSingly(const BoxTarget& box, const RayPacket& rays) {
  for (int k = 0; k < rays.rays; ++k) {
    castPacket(box, {rays.c + k, rays.s + k, 1, rays.range + k, rays.model + k});
    asm volatile("" ::: "memory");  // keeps the compiler from joining rays
  }
}

void castByBaseline(const BoxTarget& box, const RayPacket& rays) { castPacket(box, rays); }

#ifdef __x86_64__
__attribute__((target("avx2"))) void castByAvx2(const BoxTarget& box, const RayPacket& rays) {
  castPacket(box, rays);
}
#endif

}  // namespace

bool isSupported(Simd simd) {
  if (simd != Simd::kAvx2) return true;
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

CastAtBox castAtBox(Simd simd) {
#ifdef __x86_64__
  if (simd == Simd::kAvx2) return &castByAvx2;
#endif
  return simd == Simd::kNone ? &castSingly : &castByBaseline;
}

CastAtBox castAtBox() {
  static const CastAtBox fastest =
      castAtBox(isSupported(Simd::kAvx2) ? Simd::kAvx2 : Simd::kBaseline);
  return fastest;
}

}  // namespace kiva
