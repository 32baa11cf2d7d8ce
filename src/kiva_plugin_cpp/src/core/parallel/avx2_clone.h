// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before a function: compiles it a second time for processors with AVX2, where there are such, and
/// has the program choose as it starts. Both give the same results to the bit.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define KIVA_AVX2_CLONE __attribute__((target_clones("avx2", "default")))
#else
#define KIVA_AVX2_CLONE
#endif
