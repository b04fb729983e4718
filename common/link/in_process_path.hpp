// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/chunk_path.hpp"

#include <functional>
#include <memory>

namespace edgesplat::link {

struct InProcessPaths {
  std::unique_ptr<ChunkPath> robot;
  std::unique_ptr<ChunkPath> server;
};

/// Both ends of a chunk path inside one process: what one end writes the other can take at once. At most
/// `limit_chunks` wait in each direction, more are kBusy. A wake function, which may be empty, is called on
/// the other end's thread when there is something to take. The ends may be destroyed in any order.
[[nodiscard]] InProcessPaths make_in_process_paths(std::size_t limit_chunks = 256,
                                                   std::function<void()> wake_robot = {},
                                                   std::function<void()> wake_server = {});

}  // namespace edgesplat::link
