// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/mcap_types.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace edgesplat::io::mcap {

/// MCAP's names: "", "lz4", "zstd".
[[nodiscard]] std::string_view to_string(McapCompression compression);
/// kCorrupt for another name.
[[nodiscard]] Result<McapCompression> compression_from_string(std::string_view name);

/// Compresses chunks; keeps its working memory from one to the next. Single-owner.
class Compressor {
 public:
  Compressor(McapCompression compression, int zstd_level);
  Compressor(Compressor&&) noexcept;
  Compressor(const Compressor&) = delete;
  Compressor& operator=(Compressor&&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor();
  [[nodiscard]] McapCompression compression() const { return compression_; }
  /// Appends to `out`.
  [[nodiscard]] Status append(std::span<const std::byte> plain, std::vector<std::byte>& out);

 private:
  struct ZstdContext;
  McapCompression compression_;
  int zstd_level_;
  std::unique_ptr<ZstdContext> zstd_;
};

/// Exactly `plain_bytes` bytes, else kCorrupt. Memory grows with what really comes out, so a wrong length
/// costs nothing; `plain_bytes` must not exceed kMaxMcapRecordBytes.
[[nodiscard]] Result<std::vector<std::byte>> decompress(McapCompression compression,
                                                        std::span<const std::byte> compressed,
                                                        std::uint64_t plain_bytes);

}  // namespace edgesplat::io::mcap
