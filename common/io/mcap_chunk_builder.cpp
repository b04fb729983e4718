// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_chunk_builder.hpp"

#include <algorithm>

namespace edgesplat::io::mcap {
namespace {

void append_bytes(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

ChunkBuilder::ChunkBuilder(std::size_t expected_bytes) {
  records_.reserve(expected_bytes);
}

void ChunkBuilder::clear() {
  records_.clear();
  for (auto& [channel, entries] : message_indexes_) entries.clear();
  message_count_ = 0;
  first_log_time_ns_ = 0;
  last_log_time_ns_ = 0;
}

void ChunkBuilder::add(const MessageHeader& header, std::span<const std::byte> payload) {
  message_indexes_[header.channel].push_back({header.log_time_ns, records_.size()});
  first_log_time_ns_ =
      message_count_ == 0 ? header.log_time_ns : std::min(first_log_time_ns_, header.log_time_ns);
  last_log_time_ns_ = std::max(last_log_time_ns_, header.log_time_ns);
  ++message_count_;
  records_.write(static_cast<std::uint8_t>(Opcode::kMessage));
  records_.write(static_cast<std::uint64_t>(kMessageHeaderBytes + payload.size()));
  records_.write(header.channel.value);
  records_.write(header.sequence);
  records_.write(header.log_time_ns);
  records_.write(header.publish_time_ns);
  records_.write_bytes(payload);
}

bool ChunkBuilder::uses(McapChannelId channel) const {
  const auto found = message_indexes_.find(channel);
  return found != message_indexes_.end() && !found->second.empty();
}

Result<FinishedChunk> ChunkBuilder::finish(Compressor& compressor, std::uint64_t file_offset,
                                           std::vector<std::byte>& out) {
  FinishedChunk finished;
  finished.message_count = message_count_;
  ChunkIndex& index = finished.index;
  index.first_log_time_ns = first_log_time_ns_;
  index.last_log_time_ns = last_log_time_ns_;
  index.uncompressed_bytes = records_.size();
  index.compression = std::string(to_string(compressor.compression()));
  const std::size_t start = out.size();
  index.chunk_offset = file_offset;

  ByteWriter prefix;
  prefix.write(static_cast<std::uint8_t>(Opcode::kChunk));
  prefix.write(std::uint64_t{0});  // both lengths are filled in below
  prefix.write(index.first_log_time_ns);
  prefix.write(index.last_log_time_ns);
  prefix.write(index.uncompressed_bytes);
  prefix.write(crc32(records_.bytes()));
  write_string(prefix, index.compression);
  prefix.write(std::uint64_t{0});
  append_bytes(out, prefix.bytes());
  EDGESPLAT_TRY_STATUS(compressor.append(records_.bytes(), out));
  index.chunk_length = out.size() - start;
  index.compressed_bytes = index.chunk_length - prefix.size();
  const std::uint64_t content_bytes = index.chunk_length - kPrefixBytes;
  std::memcpy(out.data() + start + 1, &content_bytes, sizeof(content_bytes));
  std::memcpy(out.data() + start + prefix.size() - sizeof(std::uint64_t), &index.compressed_bytes,
              sizeof(std::uint64_t));

  ByteWriter indexes;
  for (const auto& [channel, entries] : message_indexes_) {
    if (entries.empty()) continue;
    index.message_index_offsets[channel] = file_offset + index.chunk_length + indexes.size();
    finished.messages_by_channel[channel] = entries.size();
    const RecordScope record(indexes, Opcode::kMessageIndex);
    indexes.write(channel.value);
    indexes.write(static_cast<std::uint32_t>(entries.size() * sizeof(IndexEntry)));
    indexes.write_bytes(std::as_bytes(std::span(entries)));
  }
  index.message_index_bytes = indexes.size();
  append_bytes(out, indexes.bytes());
  clear();
  return finished;
}

}  // namespace edgesplat::io::mcap
