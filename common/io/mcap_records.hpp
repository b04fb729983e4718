// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/base/result.hpp"
#include "common/io/mcap_types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

/// Layout of MCAP's records (https://mcap.dev/spec): opcode u8, length u64, then the fields below. Inside
/// common/io only.
namespace edgesplat::io::mcap {

inline constexpr std::array<std::byte, 8> kMagic = {std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                    std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                    std::byte{'\r'}, std::byte{'\n'}};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::size_t kPrefixBytes = 9;          ///< opcode and length
inline constexpr std::size_t kFooterContentBytes = 20;  ///< two offsets and a checksum
inline constexpr std::size_t kMessageHeaderBytes = 22;  ///< fields of a message before its payload

/// Begins a record; its length is filled in by the destructor. The writer must outlive it.
class RecordScope {
 public:
  RecordScope(ByteWriter& writer, Opcode opcode);
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;
  ~RecordScope();

 private:
  ByteWriter& writer_;
  std::size_t content_start_;
};

void write_string(ByteWriter& writer, std::string_view text);
[[nodiscard]] std::string read_string(ByteReader& reader);
void write_string_map(ByteWriter& writer, const std::map<std::string, std::string>& entries);
[[nodiscard]] std::map<std::string, std::string> read_string_map(ByteReader& reader);

/// CRC-32 as zlib computes it; `before` continues one.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

struct MessageHeader {
  McapChannelId channel;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
};
/// Fields of a chunk record before its compressed records.
struct ChunkHeader {
  std::uint64_t first_log_time_ns = 0;
  std::uint64_t last_log_time_ns = 0;
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0 = not available
  std::string compression;
  std::uint64_t compressed_bytes = 0;
};
struct ChunkIndex {
  std::uint64_t first_log_time_ns = 0;
  std::uint64_t last_log_time_ns = 0;
  std::uint64_t chunk_offset = 0;  ///< of the record's opcode, from the start of the file
  std::uint64_t chunk_length = 0;  ///< of the whole record
  std::map<McapChannelId, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_bytes = 0;
  std::string compression;
  std::uint64_t compressed_bytes = 0;
  std::uint64_t uncompressed_bytes = 0;
};
struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t content_bytes = 0;
  std::string name;
  std::string media_type;
};
struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};
struct Footer {
  std::uint64_t summary_start = 0;  ///< 0 = no summary
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  ///< 0 = not available
};

void write_record(ByteWriter& writer, const McapSchema& schema);
void write_record(ByteWriter& writer, const McapChannel& channel);
void write_record(ByteWriter& writer, const McapMetadata& metadata);
void write_record(ByteWriter& writer, const ChunkIndex& index);
void write_record(ByteWriter& writer, const AttachmentIndex& index);
void write_record(ByteWriter& writer, const MetadataIndex& index);
void write_record(ByteWriter& writer, const McapStatistics& statistics, std::size_t schema_count,
                  std::size_t channel_count);

/// `content` is a record's content without opcode and length. kCorrupt where it does not fit.
[[nodiscard]] Result<McapSchema> read_schema(std::span<const std::byte> content);
[[nodiscard]] Result<McapChannel> read_channel(std::span<const std::byte> content);
[[nodiscard]] Result<McapMetadata> read_metadata(std::span<const std::byte> content);
[[nodiscard]] Result<McapAttachment> read_attachment(std::span<const std::byte> content);
[[nodiscard]] Result<ChunkIndex> read_chunk_index(std::span<const std::byte> content);
[[nodiscard]] Result<AttachmentIndex> read_attachment_index(std::span<const std::byte> content);
[[nodiscard]] Result<MetadataIndex> read_metadata_index(std::span<const std::byte> content);
[[nodiscard]] Result<McapStatistics> read_statistics(std::span<const std::byte> content);
[[nodiscard]] Result<Footer> read_footer(std::span<const std::byte> content);
/// Only the first kMessageHeaderBytes of `content`.
[[nodiscard]] Result<MessageHeader> read_message_header(std::span<const std::byte> content);
/// `content` may end after the header; `header_bytes` is where the compressed records start.
struct ChunkPrefix {
  ChunkHeader header;
  std::size_t header_bytes = 0;
};
[[nodiscard]] Result<ChunkPrefix> read_chunk_prefix(std::span<const std::byte> content);

}  // namespace edgesplat::io::mcap
