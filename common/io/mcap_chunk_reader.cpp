// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_chunk_reader.hpp"

#include "common/io/mcap_compression.hpp"

#include <utility>

namespace edgesplat::io::mcap {

Result<std::vector<std::byte>> load_records(const ByteSource& source, const ChunkPlace& place) {
  if (place.length > kMaxMcapRecordBytes + 1024) return fail(Errc::kCorrupt, "a chunk is too large");
  EDGESPLAT_TRY(auto record, source.read(place.offset, place.length));
  if (place.is_bare) return record;
  if (record.size() < kPrefixBytes || record[0] != static_cast<std::byte>(Opcode::kChunk)) {
    return fail(Errc::kCorrupt, "there is no chunk where the index says");
  }
  const auto content = std::span<const std::byte>(record).subspan(kPrefixBytes);
  EDGESPLAT_TRY(const auto prefix, read_chunk_prefix(content));
  const auto compressed = content.subspan(prefix.header_bytes);
  if (prefix.header.compressed_bytes != compressed.size()) {
    return fail(Errc::kCorrupt, "a chunk's lengths contradict each other");
  }
  EDGESPLAT_TRY(const auto compression, compression_from_string(prefix.header.compression));
  EDGESPLAT_TRY(auto records, decompress(compression, compressed, prefix.header.uncompressed_bytes));
  if (prefix.header.uncompressed_crc != 0 && prefix.header.uncompressed_crc != crc32(records)) {
    return fail(Errc::kCorrupt, "a chunk fails its checksum");
  }
  return records;
}

Result<ChunkContents> list_records(std::span<const std::byte> records) {
  ChunkContents contents;
  ByteReader reader(records);
  while (reader.remaining() > 0) {
    const auto opcode = static_cast<Opcode>(reader.read<std::uint8_t>());
    const auto content = reader.take(reader.read<std::uint64_t>());
    if (!reader.ok()) return fail(Errc::kCorrupt, "a record is longer than its chunk");
    if (opcode == Opcode::kMessage) {
      EDGESPLAT_TRY(const auto header, read_message_header(content));
      contents.messages.push_back({static_cast<std::int64_t>(header.log_time_ns),
                                   static_cast<std::uint32_t>(reader.position() - content.size()),
                                   static_cast<std::uint32_t>(content.size()), header.channel});
    } else if (opcode == Opcode::kSchema) {
      EDGESPLAT_TRY(auto schema, read_schema(content));
      contents.schemas.push_back(std::move(schema));
    } else if (opcode == Opcode::kChannel) {
      EDGESPLAT_TRY(auto channel, read_channel(content));
      contents.channels.push_back(std::move(channel));
    }
  }
  return contents;
}

}  // namespace edgesplat::io::mcap
