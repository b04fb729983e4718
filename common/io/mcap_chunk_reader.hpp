// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/mcap_index.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace edgesplat::io::mcap {

/// Records of one chunk (or of a bare run), decompressed and checked.
[[nodiscard]] Result<std::vector<std::byte>> load_records(const ByteSource& source, const ChunkPlace& place);

/// A message among the records of a chunk.
struct MessagePlace {
  std::int64_t log_time_ns;
  std::uint32_t offset;  ///< of its content
  std::uint32_t content_bytes;
  McapChannelId channel;
};
/// What a chunk holds. Messages in the order of the chunk.
struct ChunkContents {
  std::vector<MessagePlace> messages;
  std::vector<McapSchema> schemas;
  std::vector<McapChannel> channels;
};
/// kCorrupt where a record does not fit.
[[nodiscard]] Result<ChunkContents> list_records(std::span<const std::byte> records);

}  // namespace edgesplat::io::mcap
