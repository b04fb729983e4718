// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One loop, compiled for several widths of vector and chosen at run time. A file that uses it is compiled
/// with -fno-trapping-math and -fno-math-errno (g++ vectorises ?: and sqrt on floats only then; the values
/// stay the same). Multiply-adds are fused where std::fma says so and nowhere else, so every variant gives
/// the same result to the last bit. All that a variant calls is inlined into it. A processor with AVX2 but
/// without FMA takes the baseline.

/// For everything that a variant calls: compiled into each of them for its own vectors.
#define EDGESPLAT_INLINE [[gnu::always_inline]] inline

#if defined(__x86_64__)
#ifdef __clang__  // knows no vector width here and takes 256 bits
#define EDGESPLAT_AVX512 "avx512f,avx512vl,avx512dq,avx512bw,fma"
#else
#define EDGESPLAT_AVX512 "avx512f,avx512vl,avx512dq,avx512bw,fma,prefer-vector-width=512"
#endif

/// `EDGESPLAT_SIMD_VARIANTS(fill, (float* to, int n), (to, n))` makes `fastest_fill()`, which returns a
/// pointer to the widest variant of `fill_inline(to, n)` that this processor runs.
#define EDGESPLAT_SIMD_VARIANTS(name, parameters, arguments)                                   \
  void name##_baseline parameters {                                                            \
    name##_inline arguments;                                                                   \
  }                                                                                            \
  [[gnu::target("avx2,fma"), gnu::flatten]] void name##_avx2 parameters {                      \
    name##_inline arguments;                                                                   \
  }                                                                                            \
  [[gnu::target(EDGESPLAT_AVX512), gnu::flatten]] void name##_avx512 parameters {              \
    name##_inline arguments;                                                                   \
  }                                                                                            \
  auto fastest_##name() {                                                                      \
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&             \
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {            \
      return &name##_avx512;                                                                   \
    }                                                                                          \
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &name##_avx2      \
                                                                           : &name##_baseline; \
  }
#else
#define EDGESPLAT_SIMD_VARIANTS(name, parameters, arguments) \
  void name##_baseline parameters {                          \
    name##_inline arguments;                                 \
  }                                                          \
  auto fastest_##name() {                                    \
    return &name##_baseline;                                 \
  }
#endif
