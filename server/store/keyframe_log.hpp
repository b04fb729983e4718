// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/map/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <span>
#include <vector>

namespace edgesplat::store {

struct KeyframeLogConfig {
  std::uint64_t max_bytes = std::uint64_t{4} << 30U;       ///< of all segments; the oldest goes first
  std::uint64_t segment_bytes = std::uint64_t{64} << 20U;  ///< a new file is begun after so many
};

/// A keyframe as it came over the link.
struct LoggedKeyframe {
  map::RobotId robot;
  std::uint64_t session = 0;
  std::vector<std::byte> bytes;  ///< map::decode_keyframe() reads them
};

/// Keyframes on the disk, in files `keyframes-NNNNNN.log` of a folder: appended to, never changed, the oldest
/// file removed over the byte cap. What append() said yes to is on the disk. Single-owner.
class KeyframeLog {
 public:
  /// Makes the folder where there is none. What a crash left half written at the end is cut off. kIo with the
  /// system's reason.
  static Result<KeyframeLog> open(const std::filesystem::path& folder, const KeyframeLogConfig& config);

  /// On the disk when it returns. After an error (a full disk: kIo) nothing of this one is visible and the
  /// log goes on.
  [[nodiscard]] Status append(map::RobotId robot, std::uint64_t session, std::span<const std::byte> keyframe);
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// The `index`-th of size(), oldest first. kCorrupt where the disk lost it since, kIo.
  [[nodiscard]] Result<LoggedKeyframe> read(std::size_t index) const;
  /// Keyframes given up because of the cap, and bytes passed over as damaged when it was opened.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] std::uint64_t damaged_bytes() const { return damaged_bytes_; }

 private:
  struct Entry {
    std::uint32_t segment;
    std::uint64_t offset;  ///< of the payload
    std::uint32_t length;
  };
  KeyframeLog(std::filesystem::path folder, const KeyframeLogConfig& config)
      : folder_(std::move(folder)), config_(config) {}

  [[nodiscard]] std::filesystem::path path_of(std::uint32_t segment) const;
  [[nodiscard]] Status scan(std::uint32_t segment, bool last);
  [[nodiscard]] Status begin_segment(std::uint32_t segment);
  void drop_oldest_segments();

  std::filesystem::path folder_;
  KeyframeLogConfig config_;
  std::deque<Entry> entries_;
  std::deque<std::pair<std::uint32_t, std::uint64_t>> segments_;  ///< number and bytes, oldest first
  UniqueFd fd_;                                                   ///< of the last segment
  std::uint64_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t damaged_bytes_ = 0;
};

/// What the newest segment of a folder's log and the one before it hold, oldest first, without opening the
/// log; what is damaged is left out. Empty where there is no log. kIo.
[[nodiscard]] Result<std::vector<LoggedKeyframe>> read_newest_keyframes(const std::filesystem::path& folder);

}  // namespace edgesplat::store
