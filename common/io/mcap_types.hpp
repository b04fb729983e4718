// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/strong_id.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::io {

/// Ids as MCAP files hold them (https://mcap.dev/spec). Schema 0 means "no schema".
using McapSchemaId = StrongId<struct McapSchemaTag, std::uint16_t>;
using McapChannelId = StrongId<struct McapChannelTag, std::uint16_t>;

enum class McapCompression : std::uint8_t { kNone, kLz4, kZstd };

/// Largest chunk, message or attachment that is written or accepted, uncompressed.
inline constexpr std::uint64_t kMaxMcapRecordBytes = std::uint64_t{256} << 20U;

struct McapSchema {
  McapSchemaId id;
  std::string name;      ///< "sensor_msgs/msg/CompressedImage"
  std::string encoding;  ///< "ros2msg"
  std::string text;
};

struct McapChannel {
  McapChannelId id;
  McapSchemaId schema_id;
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  std::map<std::string, std::string> metadata;
};

/// One message of a file. `channel` and `payload` are borrowed from the reader, valid until its next call.
struct McapMessage {
  const McapChannel* channel = nullptr;
  std::uint32_t sequence = 0;
  HostTime log_time{};        ///< arrival
  SensorTime publish_time{};  ///< the device's stamp
  std::span<const std::byte> payload;
};

struct McapAttachment {
  std::string name;
  std::string media_type;
  HostTime log_time{};
  std::vector<std::byte> content;
};

struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> entries;
};

struct McapStatistics {
  std::uint64_t message_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  HostTime first_log_time{};  ///< both 0 in a file without messages
  HostTime last_log_time{};
  std::map<McapChannelId, std::uint64_t> messages_by_channel;
};

/// What reading found. `why` is empty exactly when `complete`.
struct McapReadReport {
  bool complete = true;              ///< the file was closed properly and nothing so far was unreadable
  bool used_summary = true;          ///< false: indexed by scanning the file from the start
  std::uint64_t messages_read = 0;   ///< handed out by next() since the last select()
  std::uint64_t chunks_skipped = 0;  ///< chunks that failed their checks
  std::uint64_t bytes_skipped = 0;   ///< bytes of the file that could not be used
  std::string why;                   ///< "recording truncated at byte 123: kept 1234 messages"
};

}  // namespace edgesplat::io
