// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/thread/parallel_for.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace edgesplat::tracking {

/// Runs body(block, first, last) over [0, count) cut into blocks of a fixed size, on the threads of one
/// arena. The cut does not depend on the number of threads: results kept per block and summed in the order of
/// blocks have the same bits for any number. Thread-bound.
class BlockLoop {
 public:
  explicit BlockLoop(int threads) : threads_(threads), arena_(threads) {}

  [[nodiscard]] static std::size_t blocks(std::size_t count, std::size_t block_size) {
    return (count + block_size - 1) / block_size;
  }

  template <typename Body>
  void run(std::size_t count, std::size_t block_size, const Body& body) {
    const std::size_t n = blocks(count, block_size);
    const auto one = [&](std::size_t block) {
      body(block, block * block_size, std::min(count, (block + 1) * block_size));
    };
    if (threads_ == 1 || n < 2) {
      for (std::size_t block = 0; block < n; ++block) one(block);
      return;
    }
    arena_.execute([&] { thread::parallel_for(std::size_t{0}, n, one); });
  }

 private:
  int threads_;
  tbb::task_arena arena_;
};

}  // namespace edgesplat::tracking
