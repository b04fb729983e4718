// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <span>
#include <vector>

/// Whole buffers to and from gzip and zstd, and from bzip2. Inside common/io only.
namespace edgesplat::io {

/// kIo where there is no memory for it.
[[nodiscard]] Result<std::vector<std::byte>> gzip(std::span<const std::byte> plain);
/// kCorrupt for damage, truncation and what grows beyond `max_bytes`; memory grows with what comes out.
[[nodiscard]] Result<std::vector<std::byte>> gunzip(std::span<const std::byte> compressed,
                                                    std::size_t max_bytes);

/// Exactly `plain_bytes`, else kCorrupt; memory grows with what comes out.
[[nodiscard]] Result<std::vector<std::byte>> bunzip2(std::span<const std::byte> compressed,
                                                     std::size_t plain_bytes);

[[nodiscard]] Result<std::vector<std::byte>> zstd_compress(std::span<const std::byte> plain, int level);
/// Exactly `plain_bytes`, else kCorrupt. They are allocated at once: check them for plausibility before.
[[nodiscard]] Result<std::vector<std::byte>> zstd_decompress(std::span<const std::byte> compressed,
                                                             std::size_t plain_bytes);

}  // namespace edgesplat::io
