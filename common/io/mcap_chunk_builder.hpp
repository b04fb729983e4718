// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/io/mcap_compression.hpp"
#include "common/io/mcap_records.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::io::mcap {

/// What became of a chunk: its entry for the summary and what it adds to the statistics.
struct FinishedChunk {
  ChunkIndex index;
  std::map<McapChannelId, std::uint64_t> messages_by_channel;
  std::uint64_t message_count = 0;
};

/// Collects records for one chunk and turns them into the chunk record and its message indexes. Single-owner.
class ChunkBuilder {
 public:
  explicit ChunkBuilder(std::size_t expected_bytes);

  void add(const McapSchema& schema) { write_record(records_, schema); }
  void add(const McapChannel& channel) { write_record(records_, channel); }
  void add(const MessageHeader& header, std::span<const std::byte> payload);

  [[nodiscard]] std::size_t size_bytes() const { return records_.size(); }
  [[nodiscard]] std::uint64_t message_count() const { return message_count_; }
  [[nodiscard]] std::uint64_t first_log_time_ns() const { return first_log_time_ns_; }

  /// True when a message of this channel was added since the last finish().
  [[nodiscard]] bool uses(McapChannelId channel) const;

  /// Appends the chunk and its message indexes to `out`, which will be written at `file_offset`, and starts
  /// an empty chunk.
  [[nodiscard]] Result<FinishedChunk> finish(Compressor& compressor, std::uint64_t file_offset,
                                             std::vector<std::byte>& out);
  /// Forgets everything added.
  void clear();

 private:
  struct IndexEntry {
    std::uint64_t log_time_ns;
    std::uint64_t offset;
  };
  ByteWriter records_;
  std::map<McapChannelId, std::vector<IndexEntry>> message_indexes_;
  std::uint64_t message_count_ = 0;
  std::uint64_t first_log_time_ns_ = 0;
  std::uint64_t last_log_time_ns_ = 0;
};

}  // namespace edgesplat::io::mcap
