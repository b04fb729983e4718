// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace edgesplat::bench {

/// Wall time of a fixed piece of work now: on two threads, 2^28 fused multiply-adds each in eight-wide
/// vectors and four copies of 8 MiB. A figure divided by it holds on a machine that is slower, or busy.
[[nodiscard]] double calibration_ms();

}  // namespace edgesplat::bench
