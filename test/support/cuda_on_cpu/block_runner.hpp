// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

struct EmulatedIndex {
  unsigned x;
};
// Of the thread that runs.
inline EmulatedIndex threadIdx, blockIdx, blockDim, gridDim;

namespace edgesplat::test {

/// Runs blocks of threads as a GPU would, on one thread of the CPU: every thread is a fiber that runs until
/// it waits for others, at a barrier of the block or an exchange of its warp. Warps, and lanes within them,
/// take turns in an order that is shuffled anew at each of these places, so that a missing barrier gives
/// different results. Aborts, saying why, where threads would hang or do what CUDA leaves undefined: some at
/// the barrier and others gone or at an exchange, an exchange without a lane of its mask. One launch at a
/// time.
void run_blocks(unsigned blocks, unsigned threads, const std::function<void()>& kernel);

/// Orders differ from seed to seed; results must not.
void set_order_seed(std::uint64_t seed);

/// Within a kernel: waits for the whole block and returns how many threads gave `counts`.
unsigned block_barrier(bool counts);
/// Within a kernel: waits for the lanes of `mask` and returns what each of them gave; valid until the
/// caller's next wait.
const std::array<std::uint64_t, 32>& warp_exchange(unsigned mask, std::uint64_t value);

}  // namespace edgesplat::test
