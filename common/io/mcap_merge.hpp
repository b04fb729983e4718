// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/mcap_chunk_reader.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/open_chunks.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

namespace edgesplat::io::mcap {

/// Walks the messages of an index in log-time order. Chunks are opened when their first message is due, and
/// while more than a budget is open, those whose next message is furthest away give their bytes back.
/// Single-owner; borrows source and index.
class MessageMerge {
 public:
  MessageMerge(const ByteSource& source, const Index& index, McapSelection selection);

  [[nodiscard]] std::optional<McapMessage> next();
  [[nodiscard]] const McapReadReport& report() const { return report_; }

 private:
  struct OpenChunk {
    const ChunkPlace* place = nullptr;
    std::vector<std::byte> records;  ///< empty = given back, loaded again when due
    std::size_t records_bytes = 0;
    std::vector<MessagePlace> messages;  ///< selected ones, by time
    std::size_t next = 0;
    [[nodiscard]] std::tuple<std::int64_t, std::uint64_t> key() const {
      return {messages[next].log_time_ns, place->offset};
    }
  };
  [[nodiscard]] bool is_selected(const ChunkPlace& place) const;
  void open_due_chunks();
  [[nodiscard]] Status open_chunk(const ChunkPlace& place);
  void keep_selected(std::vector<MessagePlace>& messages);
  void skip_chunk(const ChunkPlace& place, const Error& error);

  const ByteSource& source_;
  const Index& index_;
  McapSelection selection_;
  std::set<McapChannelId> channels_;        ///< selected
  std::vector<const ChunkPlace*> pending_;  ///< by first log time
  std::size_t next_pending_ = 0;
  OpenChunks<OpenChunk> open_;
  McapReadReport report_;
};

}  // namespace edgesplat::io::mcap
