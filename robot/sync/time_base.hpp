// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/time/clock_map.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace edgesplat::sync {

/// A stream of stamps. The IMU sits in the LiDAR and shares its clock.
enum class Stream : std::uint8_t { kPoints, kImu, kCamera };

/// Puts the stamps of all devices on one time line. The first measurement decides which: if its clock is
/// disciplined (PTP, GPS), stamps of disciplined devices pass unchanged and free-running ones are fitted to
/// that line; else every device is fitted to the arrivals. A clock that jumps afterwards is fitted anew, so
/// that the line itself never jumps. An arrival of 0 means unknown: nothing is learnt from it. Single-owner.
class TimeBase {
 public:
  explicit TimeBase(const ClockMapConfig& config);

  /// The stamp on the common line. `stamp` should be the latest moment that the message tells about.
  [[nodiscard]] HostTime to_host(Stream stream, SensorTime stamp, HostTime arrival,
                                 sensor::StampSource source);
  /// Stamps of this stream pass unchanged; otherwise the relation is refined while running.
  [[nodiscard]] bool is_exact(Stream stream) const;
  [[nodiscard]] std::uint64_t clock_changes() const;

 private:
  enum class Base : std::uint8_t { kUndecided, kStamps, kArrivals };
  struct Device {
    std::optional<sensor::StampSource> source;
    bool exact = false;
    bool jumped = false;  ///< a disciplined clock that jumped is fitted from then on
    bool learnt = false;
    SensorTime newest{};
    int strays = 0;  ///< messages in a row that are far older than the newest
    ClockMap map;
  };
  Device& device(Stream stream) { return devices_.at(static_cast<std::size_t>(stream)); }
  [[nodiscard]] const Device& device(Stream stream) const {
    return devices_.at(static_cast<std::size_t>(stream));
  }
  void change_source(Stream stream, sensor::StampSource source);
  void watch_exact(Stream stream, SensorTime stamp, HostTime arrival);
  void learn(Device& d, SensorTime stamp, HostTime arrival);

  ClockMapConfig config_;
  Base base_ = Base::kUndecided;
  std::array<Device, 3> devices_;
  std::optional<std::int64_t> arrival_minus_base_ns_;  ///< from a disciplined device, smallest latency
  std::optional<Stream> reference_;                    ///< the stream that arrival_minus_base_ns_ comes from
  std::uint64_t clock_changes_ = 0;
};

}  // namespace edgesplat::sync
