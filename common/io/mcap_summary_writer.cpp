// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_summary_writer.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::io::mcap {
namespace {

struct Group {
  Opcode opcode;
  std::uint64_t start;
  std::uint64_t length;
};

/// Writes one kind of record and remembers where its group lies.
template <typename Records, typename Write>
void write_group(ByteWriter& out, std::vector<Group>& groups, Opcode opcode, const Records& records,
                 Write write) {
  const std::size_t start = out.size();
  for (const auto& record : records) write(record);
  if (out.size() > start) groups.push_back({opcode, start, out.size() - start});
}

}  // namespace

void Summary::add(FinishedChunk chunk) {
  ++statistics.chunk_count;
  if (chunk.message_count > 0) {
    const auto first = host_time_from_ns(static_cast<std::int64_t>(chunk.index.first_log_time_ns));
    const auto last = host_time_from_ns(static_cast<std::int64_t>(chunk.index.last_log_time_ns));
    const bool is_first = statistics.message_count == 0;
    statistics.first_log_time = is_first ? first : std::min(statistics.first_log_time, first);
    statistics.last_log_time = is_first ? last : std::max(statistics.last_log_time, last);
  }
  statistics.message_count += chunk.message_count;
  for (const auto& [channel, count] : chunk.messages_by_channel) {
    statistics.messages_by_channel[channel] += count;
  }
  chunks.push_back(std::move(chunk.index));
}

std::vector<std::byte> encode_file_end(const Summary& summary, std::uint64_t file_offset) {
  ByteWriter out;
  {
    const RecordScope data_end(out, Opcode::kDataEnd);
    out.write(std::uint32_t{0});  // no checksum of the data section: each chunk has its own
  }
  const std::size_t summary_start = out.size();
  std::vector<Group> groups;
  const auto plain = [&out](const auto& record) { write_record(out, record); };
  write_group(out, groups, Opcode::kSchema, summary.schemas, plain);
  write_group(out, groups, Opcode::kChannel, summary.channels, plain);
  write_group(out, groups, Opcode::kStatistics, std::span(&summary.statistics, 1), [&](const auto& record) {
    write_record(out, record, summary.schemas.size(), summary.channels.size());
  });
  write_group(out, groups, Opcode::kChunkIndex, summary.chunks, plain);
  write_group(out, groups, Opcode::kAttachmentIndex, summary.attachments, plain);
  write_group(out, groups, Opcode::kMetadataIndex, summary.metadata, plain);

  const std::size_t offsets_start = out.size();
  for (const auto& group : groups) {
    const RecordScope record(out, Opcode::kSummaryOffset);
    out.write(static_cast<std::uint8_t>(group.opcode));
    out.write(file_offset + group.start);
    out.write(group.length);
  }
  out.write(static_cast<std::uint8_t>(Opcode::kFooter));
  out.write(static_cast<std::uint64_t>(kFooterContentBytes));
  out.write(file_offset + summary_start);
  out.write(file_offset + offsets_start);
  out.write(crc32(out.bytes().subspan(summary_start)));
  out.write_bytes(kMagic);
  return out.take();
}

}  // namespace edgesplat::io::mcap
