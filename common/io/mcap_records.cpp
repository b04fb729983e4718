// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_records.hpp"

#include <zlib.h>

namespace edgesplat::io::mcap {

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

RecordScope::RecordScope(ByteWriter& writer, Opcode opcode) : writer_(writer) {
  writer_.write(static_cast<std::uint8_t>(opcode));
  writer_.write(std::uint64_t{0});
  content_start_ = writer_.size();
}

RecordScope::~RecordScope() {
  writer_.patch(content_start_ - sizeof(std::uint64_t),
                static_cast<std::uint64_t>(writer_.size() - content_start_));
}

void write_string(ByteWriter& writer, std::string_view text) {
  writer.write(static_cast<std::uint32_t>(text.size()));
  writer.write_text(text);
}

void write_string_map(ByteWriter& writer, const std::map<std::string, std::string>& entries) {
  const std::size_t length_position = writer.size();
  writer.write(std::uint32_t{0});
  for (const auto& [key, value] : entries) {
    write_string(writer, key);
    write_string(writer, value);
  }
  writer.patch(length_position,
               static_cast<std::uint32_t>(writer.size() - length_position - sizeof(std::uint32_t)));
}

void write_record(ByteWriter& writer, const McapSchema& schema) {
  const RecordScope record(writer, Opcode::kSchema);
  writer.write(schema.id.value);
  write_string(writer, schema.name);
  write_string(writer, schema.encoding);
  write_string(writer, schema.text);
}

void write_record(ByteWriter& writer, const McapChannel& channel) {
  const RecordScope record(writer, Opcode::kChannel);
  writer.write(channel.id.value);
  writer.write(channel.schema_id.value);
  write_string(writer, channel.topic);
  write_string(writer, channel.message_encoding);
  write_string_map(writer, channel.metadata);
}

void write_record(ByteWriter& writer, const McapMetadata& metadata) {
  const RecordScope record(writer, Opcode::kMetadata);
  write_string(writer, metadata.name);
  write_string_map(writer, metadata.entries);
}

void write_record(ByteWriter& writer, const ChunkIndex& index) {
  const RecordScope record(writer, Opcode::kChunkIndex);
  writer.write(index.first_log_time_ns);
  writer.write(index.last_log_time_ns);
  writer.write(index.chunk_offset);
  writer.write(index.chunk_length);
  constexpr std::size_t kEntryBytes = sizeof(std::uint16_t) + sizeof(std::uint64_t);
  writer.write(static_cast<std::uint32_t>(index.message_index_offsets.size() * kEntryBytes));
  for (const auto& [channel, offset] : index.message_index_offsets) {
    writer.write(channel.value);
    writer.write(offset);
  }
  writer.write(index.message_index_bytes);
  write_string(writer, index.compression);
  writer.write(index.compressed_bytes);
  writer.write(index.uncompressed_bytes);
}

void write_record(ByteWriter& writer, const AttachmentIndex& index) {
  const RecordScope record(writer, Opcode::kAttachmentIndex);
  writer.write(index.offset);
  writer.write(index.length);
  writer.write(index.log_time_ns);
  writer.write(std::uint64_t{0});  // create time: not known
  writer.write(index.content_bytes);
  write_string(writer, index.name);
  write_string(writer, index.media_type);
}

void write_record(ByteWriter& writer, const MetadataIndex& index) {
  const RecordScope record(writer, Opcode::kMetadataIndex);
  writer.write(index.offset);
  writer.write(index.length);
  write_string(writer, index.name);
}

void write_record(ByteWriter& writer, const McapStatistics& statistics, std::size_t schema_count,
                  std::size_t channel_count) {
  const RecordScope record(writer, Opcode::kStatistics);
  writer.write(statistics.message_count);
  writer.write(static_cast<std::uint16_t>(schema_count));
  writer.write(static_cast<std::uint32_t>(channel_count));
  writer.write(statistics.attachment_count);
  writer.write(statistics.metadata_count);
  writer.write(statistics.chunk_count);
  writer.write(static_cast<std::uint64_t>(to_ns(statistics.first_log_time)));
  writer.write(static_cast<std::uint64_t>(to_ns(statistics.last_log_time)));
  constexpr std::size_t kEntryBytes = sizeof(std::uint16_t) + sizeof(std::uint64_t);
  writer.write(static_cast<std::uint32_t>(statistics.messages_by_channel.size() * kEntryBytes));
  for (const auto& [channel, count] : statistics.messages_by_channel) {
    writer.write(channel.value);
    writer.write(count);
  }
}

}  // namespace edgesplat::io::mcap
