// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Include before hwy/foreach_target.h and hwy/highway.h. Which vector instructions the loops written with
/// Highway are compiled for: AVX-512, AVX2, SSE4 and plain C++ on x86, NEON on ARM. Vectors of a length known
/// only at run time (SVE) are left out: a block of 16 pixels is a whole number of registers.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
