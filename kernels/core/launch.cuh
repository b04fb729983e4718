// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/cuda_status.cuh"
#include "kernels/core/stream.hpp"

#include <cstddef>

namespace edgesplat::core {

inline constexpr unsigned kWarp = 32;
inline constexpr unsigned kAllLanes = 0xFFFFFFFFU;

struct LaunchShape {
  unsigned blocks;
  unsigned threads;
};

/// Blocks of `threads` that hold one thread for each of `count` items.
inline LaunchShape one_thread_each(std::size_t count, unsigned threads = 256) {
  return {static_cast<unsigned>((count + threads - 1) / threads), threads};
}

/// Puts a kernel into the stream; nothing for no blocks. A function instead of <<<>>>, so that any C++
/// compiler takes the file: the tests run these kernels on the CPU (test/support/cuda_on_cpu).
template <typename... Parameters>
[[nodiscard]] Status launch(const Stream& stream, LaunchShape shape, void (*kernel)(Parameters...),
                            Parameters... arguments) {
  if (shape.blocks == 0) return {};
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(shape.blocks);
  config.blockDim = dim3(shape.threads);
  config.stream = stream.get();
  return cuda_status(cudaLaunchKernelEx(&config, kernel, arguments...), "starting a kernel");
}

}  // namespace edgesplat::core
