// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/byte_source.hpp"
#include "common/io/mcap_records.hpp"
#include "common/io/mcap_types.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace edgesplat::io::mcap {

/// Where messages lie in a file: a chunk record, or a run of bare records outside chunks.
struct ChunkPlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  bool is_bare = false;
  HostTime first_log_time{};
  HostTime last_log_time{};
  std::vector<McapChannelId> channels;  ///< ascending; empty = not known
};

/// What is in a file, from its summary or from a scan.
struct Index {
  std::map<McapSchemaId, McapSchema> schemas;
  std::map<McapChannelId, McapChannel> channels;
  std::vector<ChunkPlace> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  McapStatistics statistics;
  McapReadReport report;
};

/// Says in the report that something is missing.
void add_problem(McapReadReport& report, std::string_view sentence);

struct RecordPrefix {
  Opcode opcode;
  std::uint64_t content_bytes;
};
/// kCorrupt where the record does not fit between `offset` and the end.
[[nodiscard]] Result<RecordPrefix> read_prefix(const ByteSource& source, std::uint64_t offset);

/// From the summary; an error says why it cannot be used (then scan): kNotFound where a proper file was
/// written without one, else it is damaged. All places lie within the file.
[[nodiscard]] Result<Index> index_from_summary(const ByteSource& source);
/// From every record of the data section; damage shows in the report.
[[nodiscard]] Index index_by_scanning(const ByteSource& source);
/// The next place from `offset` on where a chunk record may begin (its lengths agree with each other).
[[nodiscard]] std::optional<std::uint64_t> find_chunk(const ByteSource& source, std::uint64_t offset);

}  // namespace edgesplat::io::mcap
