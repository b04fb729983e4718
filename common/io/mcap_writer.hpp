// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/mcap_types.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace edgesplat::io {

struct McapWriterOptions {
  std::string profile = "ros2";
  std::string library = "edgesplat";
  std::uint64_t chunk_bytes = std::uint64_t{1} << 20U;  ///< uncompressed, [1, 128 Mi]
  McapCompression compression = McapCompression::kZstd;
  int zstd_level = 1;                  ///< [1, 19]
  nanoseconds chunk_span{1000000000};  ///< a chunk reaches the file after this much log time at the latest
};

/// Writes one MCAP file, and holds a lock on it (flock) meanwhile. Each finished chunk goes to the file at
/// once, so a killed program loses at most the last `chunk_span` (recover_mcap() makes it whole again); the
/// summary comes with close(). When the disk is full (or any write fails) the call that met it returns kIo
/// once and the file is cut back to its last whole record; from then on messages are dropped and counted, and
/// close() says so. Single-owner; write() compresses a chunk now and then (a few ms).
class McapWriter {
 public:
  static Result<McapWriter> create(const std::filesystem::path& path, McapWriterOptions options = {});
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) = delete;
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;
  /// Closes if close() was not called; its error is lost then.
  ~McapWriter();

  /// The id of an equal schema where one was added before. kInvalidArgument beyond 65535 schemas.
  [[nodiscard]] Result<McapSchemaId> add_schema(std::string_view name, std::string_view encoding,
                                                std::string_view text);
  [[nodiscard]] Result<McapChannelId> add_channel(std::string_view topic, McapSchemaId schema,
                                                  std::string_view message_encoding = "cdr",
                                                  std::map<std::string, std::string> metadata = {});
  /// Log times may go back a little; readers sort. A negative `publish_time` is kept (as two's complement), a
  /// negative `log_time`, an unknown channel or more than 64 MiB is kInvalidArgument.
  [[nodiscard]] Status write(McapChannelId channel, std::uint32_t sequence, HostTime log_time,
                             SensorTime publish_time, std::span<const std::byte> payload);
  [[nodiscard]] Status add_attachment(std::string_view name, std::string_view media_type,
                                      std::span<const std::byte> content, HostTime log_time = {});
  [[nodiscard]] Status add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);
  /// Brings the messages so far to the file.
  [[nodiscard]] Status flush();
  /// The same, and to the disk: what is there outlives a power cut. May take long on a slow disk.
  [[nodiscard]] Status sync();
  /// Writes the summary and syncs to the disk; calling it again does nothing.
  [[nodiscard]] Status close();

  [[nodiscard]] const McapStatistics& statistics() const;  ///< of what has reached the file
  [[nodiscard]] std::uint64_t messages_dropped() const;    ///< after a failed write
  [[nodiscard]] std::uint64_t bytes_written() const;       ///< size of the file so far

 private:
  class File;
  explicit McapWriter(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
};

}  // namespace edgesplat::io
