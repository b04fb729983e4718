// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock_map.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace edgesplat::sync {

/// A stream of stamps. The IMU sits in the first LiDAR and shares its clock, unless the configuration says
/// otherwise. Every LiDAR has a clock of its own.
enum class Stream : std::uint8_t { kPoints, kImu, kCamera, kMorePoints };
inline constexpr std::size_t kStreams = 2 + sensor::kMostLidars;

/// The points of one of the rig's LiDARs. Precondition: unit < sensor::kMostLidars.
[[nodiscard]] constexpr Stream points_of(std::size_t unit) {
  return unit == 0 ? Stream::kPoints
                   : static_cast<Stream>(static_cast<std::size_t>(Stream::kMorePoints) + unit - 1);
}

/// Puts the stamps of all devices on one time line. The first measurement decides which: if its clock is
/// disciplined (PTP, GPS), stamps of disciplined devices pass unchanged and free-running ones are fitted to
/// that line; else every device is fitted to the arrivals. A clock that jumps afterwards is fitted anew, so
/// that the line itself never jumps. An arrival of 0 means unknown: nothing is learnt from it.
///
/// A device may say that its clock is disciplined when its master is long gone. Two such clocks that drift
/// apart by more than `disagree_limit_s` since they were first seen show it; the one that moved more against
/// the host's clock is no longer believed, and fitted like a free-running one. Where there are several LiDARs
/// the same becomes of one whose time is off by more than half a second when it is first heard (another
/// master, another time scale) or steps ahead of its arrivals: it would pass the others by. Single-owner.
class TimeBase {
 public:
  explicit TimeBase(const ClockMapConfig& config, double disagree_limit_s = 0.5e-3,
                    bool imu_has_own_clock = false, std::size_t lidars = 1);

  /// The stamp on the common line. `stamp` should be the latest moment that the message tells about.
  [[nodiscard]] HostTime to_host(Stream stream, SensorTime stamp, HostTime arrival,
                                 sensor::StampSource source);
  /// Stamps of this stream pass unchanged; otherwise the relation is refined while running.
  [[nodiscard]] bool is_exact(Stream stream) const;
  [[nodiscard]] std::uint64_t clock_changes() const;
  /// Clocks that said they were disciplined and drifted.
  [[nodiscard]] std::uint64_t lies() const { return lies_; }

  /// What is known of a stream's clock against the host's.
  struct ClockState {
    bool exact = false;      ///< its stamps pass unchanged
    double offset_s = 0.0;   ///< least arrival - stamp; exact: beyond that of the first exact stream
    double drift_ppm = 0.0;  ///< its rate against the host's
    double jitter_s = 0.0;   ///< mean lateness of arrivals beyond the least
  };
  /// Nothing before the first message with a known arrival.
  [[nodiscard]] std::optional<ClockState> clock_state(Stream stream) const;

 private:
  enum class Base : std::uint8_t { kUndecided, kStamps, kArrivals };
  /// The least (arrival - stamp) of each few seconds: steadier than a fitted line where arrivals scatter.
  struct LeastDelay {
    SensorTime began{};
    std::int64_t running_ns = 0;
    std::optional<std::int64_t> first_ns;   ///< of the first whole span
    std::optional<std::int64_t> newest_ns;  ///< of the newest whole span
    SensorTime first_end{};
    SensorTime newest_end{};
    /// Of the device's clock against the host's; 0 until two spans are whole.
    [[nodiscard]] double drift_ppm() const;
    void observe(SensorTime stamp, std::int64_t delay_ns, bool restart);
  };
  /// The least delays of a device and of the reference when they were first compared.
  struct Compared {
    std::int64_t own_ns = 0;
    std::int64_t reference_ns = 0;
  };
  /// How far each has moved since.
  struct Moved {
    double own_ns;
    double reference_ns;
  };
  struct Device {
    std::optional<sensor::StampSource> source;
    bool exact = false;
    bool jumped = false;  ///< a disciplined clock that jumped is fitted from then on
    bool learnt = false;
    SensorTime newest{};
    HostTime heard{};  ///< the newest arrival
    int strays = 0;    ///< messages in a row that are far older than the newest
    ClockMap map;
    double jitter_s = 0.0;  ///< of arrivals, smoothed
    LeastDelay least;
    std::optional<Compared> compared;  ///< with the reference, both disciplined
    std::int64_t latency_ns = 0;  ///< of its arrivals beyond those of the reference, as far as it is known
  };
  Device& device(Stream stream) { return devices_.at(static_cast<std::size_t>(stream)); }
  [[nodiscard]] const Device& device(Stream stream) const {
    return devices_.at(static_cast<std::size_t>(stream));
  }
  [[nodiscard]] static bool is_lidar(Stream stream) { return stream != Stream::kCamera; }
  [[nodiscard]] ClockMapConfig watching(Stream stream) const;
  [[nodiscard]] bool is_far_off(Stream stream, SensorTime stamp, HostTime arrival) const;
  void change_source(Stream stream, sensor::StampSource source);
  void watch_exact(Stream stream, SensorTime stamp, HostTime arrival);
  void learn(Device& d, SensorTime stamp, HostTime arrival);
  void observe(Device& d, SensorTime stamp, HostTime arrival);
  void fit_from_now(Device& d, std::int64_t latency_ns);
  void look_for_lies();
  [[nodiscard]] static std::optional<Moved> compare(Device& d, const Device& reference);
  [[nodiscard]] static std::int64_t offset_ns(const Device& d);
  void refer_to(Stream stream);

  ClockMapConfig config_;
  double disagree_limit_ns_;
  bool imu_has_own_clock_;
  bool has_several_lidars_;
  Base base_ = Base::kUndecided;
  std::array<Device, kStreams> devices_;
  std::optional<std::int64_t> arrival_minus_base_ns_;  ///< from a disciplined device, smallest latency
  std::optional<Stream> reference_;                    ///< the stream that arrival_minus_base_ns_ comes from
  std::uint64_t clock_changes_ = 0;
  std::uint64_t lies_ = 0;
};

}  // namespace edgesplat::sync
