// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Records of ROS 1 bags (http://wiki.ros.org/Bags/Format/2.0): u32 header length, fields (u32 length,
/// name=value), u32 data length, data. Inside common/io only.
namespace edgesplat::io::rosbag1 {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
/// Largest chunk accepted, uncompressed.
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{256} << 20U;

enum class Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// The fields of a record's header that are used; those that are absent stay 0 or empty.
struct RecordHeader {
  std::uint8_t op = 0;
  std::uint32_t connection = 0;
  std::int64_t time_ns = 0;
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  std::uint64_t index_pos = 0;
  std::uint64_t chunk_pos = 0;
  std::uint32_t connection_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint32_t size_bytes = 0;  ///< of a chunk, uncompressed
  std::string compression;
  std::string topic;
  std::string type;
};

/// One record among bytes in memory.
struct Record {
  RecordHeader header;
  std::span<const std::byte> data;
  std::size_t total_bytes = 0;
};
/// The record at the front of `bytes`; kCorrupt where it does not fit.
[[nodiscard]] Result<Record> read_record(std::span<const std::byte> bytes);

/// A record in the file, its data not read.
struct RecordPlace {
  RecordHeader header;
  std::uint64_t data_offset = 0;
  std::uint32_t data_bytes = 0;
  [[nodiscard]] std::uint64_t end_offset() const { return data_offset + data_bytes; }
};
/// kCorrupt where it does not fit in the file.
[[nodiscard]] Result<RecordPlace> read_record_place(const ByteSource& source, std::uint64_t offset);

/// Who wrote what: a topic with its type. Several connections may share a topic.
struct Connection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;
};
/// From a connection record: the topic is in its header, the type in its data.
[[nodiscard]] Result<Connection> read_connection(const Record& record);

/// A message among the records of a chunk.
struct MessagePlace {
  std::int64_t time_ns;
  std::uint32_t offset;  ///< of its payload
  std::uint32_t bytes;
  std::uint32_t connection;
};
struct ChunkContents {
  std::vector<MessagePlace> messages;  ///< in the order of the chunk
  std::vector<Connection> connections;
};
/// kCorrupt where a record does not fit.
[[nodiscard]] Result<ChunkContents> list_chunk(std::span<const std::byte> records);
/// The records of the chunk at `offset`, decompressed (none, bz2 or lz4). Memory grows with what comes out.
[[nodiscard]] Result<std::vector<std::byte>> load_chunk(const ByteSource& source, std::uint64_t offset);

}  // namespace edgesplat::io::rosbag1
