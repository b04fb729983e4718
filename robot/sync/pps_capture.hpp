// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace edgesplat::sync {

/// One rising edge as the kernel stamped it.
struct PpsEdge {
  std::uint32_t sequence = 0;  ///< the kernel's count
  std::int64_t wall_ns = 0;    ///< CLOCK_REALTIME
};

/// A PPS input of the kernel (/dev/ppsN, RFC 2783's interface): the transport. Thread-bound.
class PpsDevice {
 public:
  /// kIo where it cannot be opened; kInvalidConfig where it is no PPS device or cannot capture rising edges.
  static Result<PpsDevice> open(const std::string& path);
  /// Waits for the next edge. Nothing at the timeout; kIo where the device fails.
  [[nodiscard]] Result<std::optional<PpsEdge>> wait(double timeout_s);

 private:
  PpsDevice(UniqueFd fd, std::string path) : fd_(std::move(fd)), path_(std::move(path)) {}
  UniqueFd fd_;
  std::string path_;
  std::optional<std::uint32_t> newest_;
};

struct PpsCounters {
  std::uint64_t edges = 0;
  std::uint64_t lost = 0;      ///< seconds without an edge
  std::uint64_t strays = 0;    ///< edges that came where none belongs: not used
  std::uint64_t restarts = 0;  ///< the source began anew
};

/// The once-a-second pulse: which edges are real, how steady it is. Pure, single-owner.
class PpsTrack {
 public:
  /// True where the edge is a second (or a whole number of them) after the last.
  bool add(const PpsEdge& edge);
  [[nodiscard]] const PpsCounters& counters() const { return counters_; }
  /// Mean deviation of a period from a second, and its scatter; 0 before the second edge.
  [[nodiscard]] double period_error_ppm() const { return period_error_ppm_; }
  [[nodiscard]] double jitter_us() const { return jitter_us_; }
  [[nodiscard]] std::optional<PpsEdge> newest() const { return newest_; }

 private:
  std::optional<PpsEdge> newest_;
  int strays_in_a_row_ = 0;
  double period_error_ppm_ = 0.0;
  double jitter_us_ = 0.0;
  PpsCounters counters_;
};

/// Which moment an edge was, ns since 1970. `on_seconds`: the pulses begin full seconds of UTC (a GPS
/// receiver's), and the wall clock, right to 0.3 s, says which; nothing where it is further off. Else they
/// begin anywhere (a microcontroller's), and what the wall clock showed at the edge is the moment.
[[nodiscard]] std::optional<std::int64_t> utc_of_edge(const PpsEdge& edge, bool on_seconds);

}  // namespace edgesplat::sync
