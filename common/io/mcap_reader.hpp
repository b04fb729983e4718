// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/mcap_types.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

/// Which messages next() gives: half-open in log time.
struct McapSelection {
  std::vector<std::string> topics;  ///< empty = all
  HostTime from = HostTime::min();
  HostTime until = HostTime::max();
};

/// Reads one MCAP file in log-time order (messages of equal time in the order of the file). Uses the summary
/// where it is intact, otherwise scans and recovers what is whole; report() says which, and what was lost. A
/// chunk that fails its checks is skipped and counted. Holds at most about 64 MiB of decompressed chunks (or
/// two chunks, if larger) however chunks overlap in time. Every length is checked against the file and
/// kMaxMcapRecordBytes before memory is taken. Single-owner; cost O(log overlapping chunks) a message.
class McapReader {
 public:
  /// kNotFound, kIo, or kCorrupt where it is no MCAP file at all.
  static Result<McapReader> open(const std::filesystem::path& path);
  /// From memory that the caller keeps alive.
  static Result<McapReader> from_bytes(std::span<const std::byte> bytes);
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) = delete;
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;
  ~McapReader();

  [[nodiscard]] const std::map<McapChannelId, McapChannel>& channels() const;
  [[nodiscard]] const std::map<McapSchemaId, McapSchema>& schemas() const;
  /// Of the whole file; counted while scanning where there is no summary.
  [[nodiscard]] const McapStatistics& statistics() const;
  /// The first channel of that topic, or null.
  [[nodiscard]] const McapChannel* find_channel(std::string_view topic) const;
  /// Names in the order of the file.
  [[nodiscard]] std::vector<std::string> attachment_names() const;
  /// The first of that name; kNotFound, kIo, kCorrupt (checksum).
  [[nodiscard]] Result<McapAttachment> attachment(std::string_view name) const;
  [[nodiscard]] Result<std::vector<McapMetadata>> metadata() const;

  /// Starts over with this selection; without a call next() gives everything.
  void select(McapSelection selection);
  /// The next message, or nothing at the end. Damage is skipped and shows in report().
  [[nodiscard]] std::optional<McapMessage> next();
  [[nodiscard]] const McapReadReport& report() const;

 private:
  class File;
  explicit McapReader(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
};

}  // namespace edgesplat::io
