// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>

namespace edgesplat::policy {

/// Where the map is grown and optimised (ARCHITECTURE.md "What runs where").
enum class Mode : std::uint8_t {
  kLocal,  ///< on the robot, at a small budget
  kLean,   ///< on the server, from every third keyframe, SH0 deltas
  kFull,   ///< on the server
};
enum class OffloadSetting : std::uint8_t {
  kAuto,    ///< Algorithm 1: offload when render latency or memory asks for it and the link allows it
  kAlways,  ///< offload whenever the link allows it
  kNever,   ///< the paper's pure end-side baseline
};
enum class Reason : std::uint8_t {
  kNone,
  kLatency,
  kMemory,
  kSetting,
  kBandwidth,
  kRoundTrip,
  kServerLost,
  kFailed
};
[[nodiscard]] std::string_view to_string(Mode mode);
[[nodiscard]] std::string_view to_string(Reason reason);

struct OffloadConfig {
  OffloadSetting setting = OffloadSetting::kAuto;
  double latency_threshold_ms = 33.0;         ///< T_L, p95 of a picture's render time, (0, 1000]
  double memory_threshold_bytes = 1.5e9;      ///< T_M, (0, 1e12]
  double full_bandwidth_bytes_per_s = 300e3;  ///< T_B of FULL, > lean
  double lean_bandwidth_bytes_per_s = 60e3;   ///< T_B of LEAN, > 0
  double round_trip_threshold_ms = 200.0;     ///< T_R, (0, 10000]
  double enter_factor = 1.25;                 ///< a band is entered above this times its T_B, > leave_factor
  double leave_factor = 0.8;                  ///< and left below this times its T_B
  double round_trip_leave_factor = 1.5;
  int windows_in_a_row = 3;          ///< evaluations that must agree, [1, 20]
  double evaluation_period_s = 0.5;  ///< [0.05, 5]
  double switch_interval_s = 10.0;   ///< an upgrade waits this long after any switch, and two switches an
                                     ///< upgrade adds to never share twice this span, [0, 600]
  double server_timeout_s = 2.0;     ///< without a heartbeat for this long the server is lost, [0.5, 60]
  double backoff_first_s = 5.0;      ///< after a failed offload, doubling ...
  double backoff_most_s = 60.0;      ///< ... up to this
};

/// What the robot knows at one moment. Quantities that were not measured are absent, never zero.
struct Situation {
  HostTime now{};
  std::optional<double> render_p95_ms;          ///< over the last 2 s
  std::optional<double> memory_peak_bytes;      ///< largest over the last 2 s
  std::optional<double> bandwidth_bytes_per_s;  ///< BandwidthEstimator
  std::optional<double> round_trip_ms;
  std::optional<HostTime> last_heartbeat;  ///< of the server
  bool in_step = true;                     ///< the robot's map follows the server's; upgrades wait for it
  bool offload_failed = false;             ///< an offload in progress did not come to an end
};

struct Decision {
  Mode mode = Mode::kLocal;
  Reason reason = Reason::kNone;  ///< why the mode was last changed
  bool changed = false;           ///< by this evaluation
  bool prune_and_compress =
      false;  ///< the robot is over its limits but the link does not allow it (Algorithm 1, line 8)
};

/// Algorithm 1 of the end-edge-cloud paper with averaging, hysteresis, dwell, back-off and server loss. Pure:
/// time and measurements come in, the mode comes out. Upgrades (towards FULL) are slow and rare, downgrades
/// quick: a link that is too narrow is left within windows_in_a_row evaluations whatever the dwell.
/// Single-owner. Source: paper 0, Algorithm 1; ../shared/design/link-and-offload.md section 3.
class OffloadPolicy {
 public:
  explicit OffloadPolicy(const OffloadConfig& config) : config_(config) {}

  /// To be called every evaluation_period_s; calls that come sooner return the standing decision.
  [[nodiscard]] Decision evaluate(const Situation& situation);
  /// Somebody else is to do the mapping, or does it, if only the link and the server allow it.
  [[nodiscard]] bool wants_offload(const Situation& situation) const;
  /// A wider link could change the mode: the bandwidth is worth measuring.
  [[nodiscard]] bool bandwidth_matters(const Situation& situation) const;

 private:
  [[nodiscard]] bool server_alive(const Situation& s) const;
  /// The robot is over one of its limits.
  [[nodiscard]] Reason overload(const Situation& s) const;
  /// Why somebody else should do the mapping.
  [[nodiscard]] Reason load_trigger(const Situation& s) const;
  /// The highest mode that the link supports: with `factor` times the thresholds.
  [[nodiscard]] Mode link_allows(const Situation& s, double factor, double round_trip_factor) const;
  void consider_downgrade(const Situation& s);
  void consider_upgrade(const Situation& s);
  [[nodiscard]] bool upgrade_is_due(HostTime now) const;
  void switch_to(Mode mode, Reason reason, HostTime now);

  OffloadConfig config_;
  Decision decision_;
  std::optional<HostTime> last_evaluation_;
  std::deque<HostTime> switches_;  ///< the last two
  std::optional<HostTime> blocked_until_;
  double backoff_s_ = 0.0;
  int downgrade_windows_ = 0;
  int upgrade_windows_ = 0;
};

}  // namespace edgesplat::policy
