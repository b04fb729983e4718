// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

namespace edgesplat::uplink {

struct SpoolConfig {
  std::size_t memory_bytes = std::size_t{16} << 20U;
  std::size_t disk_bytes = std::size_t{256} << 20U;  ///< 0: memory only
  std::filesystem::path folder;                      ///< empty: memory only
};

struct SpoolCounters {
  std::uint64_t put = 0;
  std::uint64_t taken = 0;
  std::uint64_t dropped = 0;  ///< oldest first, when both memory and disk are full, or the disk failed
  std::uint64_t disk_failures = 0;
  std::size_t items = 0;         ///< now
  std::size_t memory_bytes = 0;  ///< now
  std::size_t disk_bytes = 0;    ///< now
};

/// Encoded keyframes that could not be sent: the newest in memory, older ones in files of a folder that
/// belongs to the spool alone and is emptied at its start and end. Single-owner.
class Spool {
 public:
  explicit Spool(SpoolConfig config);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  void put(std::vector<std::byte> bytes);
  /// Size of what take() would give.
  [[nodiscard]] std::optional<std::size_t> next_bytes() const;
  /// The newest: what the robot sees now is worth most.
  std::optional<std::vector<std::byte>> take();
  [[nodiscard]] bool empty() const { return files_.empty() && memory_.empty(); }
  [[nodiscard]] const SpoolCounters& counters() const { return counters_; }

 private:
  struct File {
    std::filesystem::path path;
    std::size_t bytes;
  };
  void move_oldest_to_disk();
  void remove_file(const File& file);
  void drop_oldest_file();
  void remove_files();

  const SpoolConfig config_;
  std::deque<File> files_;  ///< all older than what is in memory
  std::deque<std::vector<std::byte>> memory_;
  std::uint64_t next_file_ = 0;
  SpoolCounters counters_;
};

}  // namespace edgesplat::uplink
