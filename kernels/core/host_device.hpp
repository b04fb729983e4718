// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks maths that host and device code share, so that CPU tests cover what the GPU runs.
#ifdef __CUDACC__
#define EDGESPLAT_HOST_DEVICE __host__ __device__
#else
#define EDGESPLAT_HOST_DEVICE
#endif

/// Before a short loop of known length inside a loop over many: unrolled, the outer one becomes vector
/// operations.
#if defined(__CUDACC__) || defined(__clang__)
#define EDGESPLAT_UNROLL _Pragma("unroll")
#else
#define EDGESPLAT_UNROLL _Pragma("GCC unroll 16")
#endif

/// For everything that a loop over many calls: only what is inlined to the last call becomes vector
/// operations.
#define EDGESPLAT_INLINE [[gnu::always_inline]] inline
