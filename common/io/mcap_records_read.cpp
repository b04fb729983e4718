// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_records.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::io::mcap {
namespace {

tl::unexpected<Error> does_not_fit(std::string_view record) {
  return fail(Errc::kCorrupt, "an MCAP " + std::string(record) + " record does not fit its length");
}

std::string to_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Array of (u16 channel, u64 value) preceded by its length in bytes.
std::map<McapChannelId, std::uint64_t> read_channel_map(ByteReader& reader) {
  ByteReader entries(reader.take(reader.read<std::uint32_t>()));
  std::map<McapChannelId, std::uint64_t> by_channel;
  while (entries.remaining() >= sizeof(std::uint16_t) + sizeof(std::uint64_t)) {
    const McapChannelId channel{entries.read<std::uint16_t>()};
    by_channel[channel] = entries.read<std::uint64_t>();
  }
  return by_channel;
}

}  // namespace

std::string read_string(ByteReader& reader) {
  return to_text(reader.take(reader.read<std::uint32_t>()));
}

std::map<std::string, std::string> read_string_map(ByteReader& reader) {
  ByteReader entries(reader.take(reader.read<std::uint32_t>()));
  std::map<std::string, std::string> map;
  while (entries.remaining() > 0) {
    std::string key = read_string(entries);
    std::string value = read_string(entries);
    if (!entries.ok()) {
      reader.skip(reader.remaining() + 1);  // a map that does not fit spoils its record
      break;
    }
    map.emplace(std::move(key), std::move(value));
  }
  return map;
}

Result<McapSchema> read_schema(std::span<const std::byte> content) {
  ByteReader reader(content);
  McapSchema schema;
  schema.id.value = reader.read<std::uint16_t>();
  schema.name = read_string(reader);
  schema.encoding = read_string(reader);
  schema.text = read_string(reader);
  if (!reader.ok() || schema.id.value == 0) return does_not_fit("schema");
  return schema;
}

Result<McapChannel> read_channel(std::span<const std::byte> content) {
  ByteReader reader(content);
  McapChannel channel;
  channel.id.value = reader.read<std::uint16_t>();
  channel.schema_id.value = reader.read<std::uint16_t>();
  channel.topic = read_string(reader);
  channel.message_encoding = read_string(reader);
  channel.metadata = read_string_map(reader);
  if (!reader.ok()) return does_not_fit("channel");
  return channel;
}

Result<McapMetadata> read_metadata(std::span<const std::byte> content) {
  ByteReader reader(content);
  McapMetadata metadata;
  metadata.name = read_string(reader);
  metadata.entries = read_string_map(reader);
  if (!reader.ok()) return does_not_fit("metadata");
  return metadata;
}

Result<McapAttachment> read_attachment(std::span<const std::byte> content) {
  ByteReader reader(content);
  McapAttachment attachment;
  attachment.log_time = host_time_from_ns(static_cast<std::int64_t>(reader.read<std::uint64_t>()));
  reader.skip(sizeof(std::uint64_t));  // create time
  attachment.name = read_string(reader);
  attachment.media_type = read_string(reader);
  const auto bytes = reader.take(reader.read<std::uint64_t>());
  const std::size_t checked_bytes = reader.position();
  const auto expected_crc = reader.read<std::uint32_t>();
  if (!reader.ok()) return does_not_fit("attachment");
  if (expected_crc != 0 && expected_crc != crc32(content.first(checked_bytes))) {
    return fail(Errc::kCorrupt, "attachment " + attachment.name + " fails its checksum");
  }
  attachment.content.assign(bytes.begin(), bytes.end());
  return attachment;
}

Result<ChunkIndex> read_chunk_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  ChunkIndex index;
  index.first_log_time_ns = reader.read<std::uint64_t>();
  index.last_log_time_ns = reader.read<std::uint64_t>();
  index.chunk_offset = reader.read<std::uint64_t>();
  index.chunk_length = reader.read<std::uint64_t>();
  index.message_index_offsets = read_channel_map(reader);
  index.message_index_bytes = reader.read<std::uint64_t>();
  index.compression = read_string(reader);
  index.compressed_bytes = reader.read<std::uint64_t>();
  index.uncompressed_bytes = reader.read<std::uint64_t>();
  if (!reader.ok()) return does_not_fit("chunk index");
  return index;
}

Result<AttachmentIndex> read_attachment_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  AttachmentIndex index;
  index.offset = reader.read<std::uint64_t>();
  index.length = reader.read<std::uint64_t>();
  index.log_time_ns = reader.read<std::uint64_t>();
  reader.skip(sizeof(std::uint64_t));  // create time
  index.content_bytes = reader.read<std::uint64_t>();
  index.name = read_string(reader);
  index.media_type = read_string(reader);
  if (!reader.ok()) return does_not_fit("attachment index");
  return index;
}

Result<MetadataIndex> read_metadata_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  MetadataIndex index;
  index.offset = reader.read<std::uint64_t>();
  index.length = reader.read<std::uint64_t>();
  index.name = read_string(reader);
  if (!reader.ok()) return does_not_fit("metadata index");
  return index;
}

Result<McapStatistics> read_statistics(std::span<const std::byte> content) {
  ByteReader reader(content);
  McapStatistics statistics;
  statistics.message_count = reader.read<std::uint64_t>();
  reader.skip(sizeof(std::uint16_t) + sizeof(std::uint32_t));  // numbers of schemas and channels
  statistics.attachment_count = reader.read<std::uint32_t>();
  statistics.metadata_count = reader.read<std::uint32_t>();
  statistics.chunk_count = reader.read<std::uint32_t>();
  statistics.first_log_time = host_time_from_ns(static_cast<std::int64_t>(reader.read<std::uint64_t>()));
  statistics.last_log_time = host_time_from_ns(static_cast<std::int64_t>(reader.read<std::uint64_t>()));
  statistics.messages_by_channel = read_channel_map(reader);
  if (!reader.ok()) return does_not_fit("statistics");
  return statistics;
}

Result<Footer> read_footer(std::span<const std::byte> content) {
  ByteReader reader(content);
  Footer footer;
  footer.summary_start = reader.read<std::uint64_t>();
  footer.summary_offset_start = reader.read<std::uint64_t>();
  footer.summary_crc = reader.read<std::uint32_t>();
  if (!reader.ok()) return does_not_fit("footer");
  return footer;
}

Result<MessageHeader> read_message_header(std::span<const std::byte> content) {
  ByteReader reader(content.first(std::min(content.size(), kMessageHeaderBytes)));
  MessageHeader header;
  header.channel.value = reader.read<std::uint16_t>();
  header.sequence = reader.read<std::uint32_t>();
  header.log_time_ns = reader.read<std::uint64_t>();
  header.publish_time_ns = reader.read<std::uint64_t>();
  if (!reader.ok()) return does_not_fit("message");
  return header;
}

Result<ChunkPrefix> read_chunk_prefix(std::span<const std::byte> content) {
  ByteReader reader(content);
  ChunkPrefix prefix;
  prefix.header.first_log_time_ns = reader.read<std::uint64_t>();
  prefix.header.last_log_time_ns = reader.read<std::uint64_t>();
  prefix.header.uncompressed_bytes = reader.read<std::uint64_t>();
  prefix.header.uncompressed_crc = reader.read<std::uint32_t>();
  prefix.header.compression = read_string(reader);
  prefix.header.compressed_bytes = reader.read<std::uint64_t>();
  prefix.header_bytes = reader.position();
  if (!reader.ok()) return does_not_fit("chunk");
  return prefix;
}

}  // namespace edgesplat::io::mcap
