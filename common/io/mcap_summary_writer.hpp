// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/mcap_chunk_builder.hpp"
#include "common/io/mcap_records.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::io::mcap {

/// What the end of a file says about the rest of it.
struct Summary {
  std::vector<McapSchema> schemas;    ///< id = place + 1
  std::vector<McapChannel> channels;  ///< id = place
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  McapStatistics statistics;

  void add(FinishedChunk chunk);
};

/// DataEnd, summary section, summary offsets, footer and magic, as written at `file_offset`.
[[nodiscard]] std::vector<std::byte> encode_file_end(const Summary& summary, std::uint64_t file_offset);

}  // namespace edgesplat::io::mcap
