// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/rosbag1_records.hpp"

#include "common/base/bytes.hpp"
#include "common/io/byte_compression.hpp"
#include "common/io/mcap_compression.hpp"

#include <limits>
#include <utility>

namespace edgesplat::io::rosbag1 {
namespace {

constexpr std::uint32_t kMaxHeaderBytes = 1U << 20U;

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Seconds and nanoseconds, 32 bits each.
std::int64_t read_time_ns(ByteReader& reader) {
  const std::int64_t seconds = reader.read<std::uint32_t>();
  return seconds * 1'000'000'000 + reader.read<std::uint32_t>();
}

/// False where the value has another length than the field needs.
bool set_field(RecordHeader& header, std::string_view name, std::span<const std::byte> value) {
  ByteReader reader(value);
  if (name == "op") header.op = reader.read<std::uint8_t>();
  if (name == "conn") header.connection = reader.read<std::uint32_t>();
  if (name == "time") header.time_ns = read_time_ns(reader);
  if (name == "start_time") header.start_time_ns = read_time_ns(reader);
  if (name == "end_time") header.end_time_ns = read_time_ns(reader);
  if (name == "index_pos") header.index_pos = reader.read<std::uint64_t>();
  if (name == "chunk_pos") header.chunk_pos = reader.read<std::uint64_t>();
  if (name == "conn_count") header.connection_count = reader.read<std::uint32_t>();
  if (name == "chunk_count") header.chunk_count = reader.read<std::uint32_t>();
  if (name == "size") header.size_bytes = reader.read<std::uint32_t>();
  if (name == "compression") header.compression = text_of(value);
  if (name == "topic") header.topic = text_of(value);
  if (name == "type") header.type = text_of(value);
  return reader.ok();
}

Result<RecordHeader> read_fields(std::span<const std::byte> bytes) {
  RecordHeader header;
  ByteReader reader(bytes);
  while (reader.remaining() > 0) {
    const auto field = reader.take(reader.read<std::uint32_t>());
    const std::string_view text = text_of(field);
    const std::size_t equals = text.find('=');
    if (!reader.ok() || equals == std::string_view::npos ||
        !set_field(header, text.substr(0, equals), field.subspan(equals + 1)))
      return fail(Errc::kCorrupt, "a record's header is damaged");
  }
  return header;
}

}  // namespace

Result<Record> read_record(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  const auto header_bytes = reader.take(reader.read<std::uint32_t>());
  Record record;
  record.data = reader.take(reader.read<std::uint32_t>());
  if (!reader.ok()) return fail(Errc::kCorrupt, "a record is longer than what holds it");
  EDGESPLAT_TRY(record.header, read_fields(header_bytes));
  record.total_bytes = reader.position();
  return record;
}

Result<RecordPlace> read_record_place(const ByteSource& source, std::uint64_t offset) {
  constexpr std::uint64_t kLengthBytes = 4;
  EDGESPLAT_TRY(const auto length, source.read(offset, kLengthBytes));
  const auto header_bytes = ByteReader(length).read<std::uint32_t>();
  if (header_bytes > kMaxHeaderBytes) return fail(Errc::kCorrupt, "a record's header is absurdly long");
  EDGESPLAT_TRY(const auto header, source.read(offset + kLengthBytes, header_bytes + kLengthBytes));
  RecordPlace place;
  EDGESPLAT_TRY(place.header, read_fields(std::span(header).first(header_bytes)));
  place.data_bytes = ByteReader(std::span(header).subspan(header_bytes)).read<std::uint32_t>();
  place.data_offset = offset + 2 * kLengthBytes + header_bytes;
  if (place.data_bytes > source.size_bytes() - place.data_offset)
    return fail(Errc::kCorrupt, "a record is longer than the file");
  return place;
}

Result<Connection> read_connection(const Record& record) {
  EDGESPLAT_TRY(const RecordHeader about, read_fields(record.data));
  const std::string& topic = record.header.topic.empty() ? about.topic : record.header.topic;
  if (topic.empty() || about.type.empty()) return fail(Errc::kCorrupt, "a connection has no topic or type");
  return Connection{record.header.connection, topic, about.type};
}

Result<ChunkContents> list_chunk(std::span<const std::byte> records) {
  ChunkContents contents;
  for (std::size_t at = 0; at < records.size();) {
    EDGESPLAT_TRY(const Record record, read_record(records.subspan(at)));
    at += record.total_bytes;
    if (record.header.op == static_cast<std::uint8_t>(Op::kConnection)) {
      EDGESPLAT_TRY(auto connection, read_connection(record));
      contents.connections.push_back(std::move(connection));
    }
    if (record.header.op != static_cast<std::uint8_t>(Op::kMessage)) continue;
    contents.messages.push_back({record.header.time_ns, static_cast<std::uint32_t>(at - record.data.size()),
                                 static_cast<std::uint32_t>(record.data.size()), record.header.connection});
  }
  return contents;
}

Result<std::vector<std::byte>> load_chunk(const ByteSource& source, std::uint64_t offset) {
  EDGESPLAT_TRY(const RecordPlace place, read_record_place(source, offset));
  const RecordHeader& header = place.header;
  if (header.op != static_cast<std::uint8_t>(Op::kChunk))
    return fail(Errc::kCorrupt, "there is no chunk where the index says");
  if (header.size_bytes > kMaxChunkBytes || place.data_bytes > kMaxChunkBytes)
    return fail(Errc::kCorrupt, "a chunk is too large");
  EDGESPLAT_TRY(auto bytes, source.read(place.data_offset, place.data_bytes));
  if (header.compression == "bz2") return bunzip2(bytes, header.size_bytes);
  if (header.compression == "lz4") return mcap::decompress(McapCompression::kLz4, bytes, header.size_bytes);
  if (header.compression != "none" && !header.compression.empty())
    return fail(Errc::kCorrupt, "unknown chunk compression '" + header.compression.substr(0, 16) + "'");
  if (bytes.size() != header.size_bytes)
    return fail(Errc::kCorrupt, "a chunk has another length than stated");
  return bytes;
}

}  // namespace edgesplat::io::rosbag1
