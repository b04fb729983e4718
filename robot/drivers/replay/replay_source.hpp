// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/measurement.hpp"
#include "common/sensor/rig.hpp"
#include "robot/drivers/replay/bag_rig.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace edgesplat::replay {

/// How much of a recording could be used. `why` is empty exactly when nothing was left out.
struct ReplayReport {
  bool complete = true;
  std::uint64_t measurements = 0;     ///< handed out so far
  std::uint64_t bytes_skipped = 0;    ///< of the file, not readable
  std::uint64_t packets_refused = 0;  ///< raw packets that failed their checks, duplicates included
  std::uint64_t frames_refused = 0;   ///< pictures that could not be decoded or lacked their meta message
  std::uint64_t points_dropped = 0;   ///< not finite, no return or low confidence
  std::string why;                    ///< "recording truncated at byte 123: kept 1234 messages"
};

/// A recording as a stream of measurements in arrival order. Four kinds: our `.mcap`; a folder laid out like
/// KITTI raw (velodyne/*.bin, image_02/*.{jpg,png}, calib_*.txt); a folder of KITTI `.bin` scans; a recording
/// of ROS (`.bag`, `.mcap`, `.db3`, or a folder of them), which does not say where its sensors sit. Pacing is
/// the caller's: each measurement carries its arrival time. Holds one measurement in memory (and the MCAP
/// reader's chunks). Single-owner.
class ReplaySource {
 public:
  /// `rig`, where given, takes the place of the recording's own. kNotFound for a missing path;
  /// kInvalidArgument where it is none of the four kinds, with what was expected and what was found;
  /// kInvalidConfig where a recording of ROS comes without a rig or does not fit it; kCorrupt, kIo.
  static Result<ReplaySource> open(const std::filesystem::path& path, const std::optional<BagRig>& rig = {});
  /// A folder, and not of ROS recordings.
  [[nodiscard]] static bool is_scan_folder(const std::filesystem::path& path);
  ReplaySource(ReplaySource&&) noexcept;
  ReplaySource& operator=(ReplaySource&&) noexcept;
  ReplaySource(const ReplaySource&) = delete;
  ReplaySource& operator=(const ReplaySource&) = delete;
  ~ReplaySource();

  /// The sensors and where they sit, as given to open() or from the recording.
  [[nodiscard]] const sensor::Rig& rig() const;
  /// The next measurement, or nothing at the end. An Error is one that ends the replay (the disk fails);
  /// damage is skipped, counted and in report().
  [[nodiscard]] Result<std::optional<sensor::Measurement>> next();
  [[nodiscard]] ReplayReport report() const;
  /// First to last arrival; with the arrival of the latest measurement that gives the progress.
  [[nodiscard]] nanoseconds duration() const;
  /// Arrival of the first measurement.
  [[nodiscard]] HostTime begin() const;

  /// One kind of recording; see scan_folder.hpp and mcap_recording.hpp.
  class Reader {
   public:
    virtual ~Reader() = default;
    [[nodiscard]] virtual const sensor::Rig& rig() const = 0;
    [[nodiscard]] virtual Result<std::optional<sensor::Measurement>> next() = 0;
    [[nodiscard]] virtual ReplayReport report() const = 0;
    [[nodiscard]] virtual nanoseconds duration() const = 0;
    [[nodiscard]] virtual HostTime begin() const = 0;
  };

 private:
  ReplaySource(std::unique_ptr<Reader> reader, std::optional<sensor::Rig> rig);
  std::unique_ptr<Reader> reader_;
  std::optional<sensor::Rig> rig_;  ///< instead of the reader's
};

}  // namespace edgesplat::replay
