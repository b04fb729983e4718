// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/bandwidth_estimator.hpp"
#include "common/link/flight.hpp"
#include "common/link/prober.hpp"

#include <array>
#include <cstdint>

namespace edgesplat::link {

/// What one end knows about the way to one peer: the sending times of what is sent only once, the bandwidth
/// estimate and when to probe. Single-owner.
class PeerLink {
 public:
  PeerLink(const BandwidthConfig& bandwidth, const ProbeConfig& probe)
      : estimator(bandwidth), prober(probe), bandwidth_(bandwidth), probe_(probe) {}

  /// The peer's program speaks as `session`. Of another one than before everything is measured anew: the
  /// silence in between was no narrow link. False for the session before, which is over.
  bool meet(std::uint64_t session);
  /// A heartbeat or a probe left.
  void sent_single(Lane lane, std::uint32_t train, HostTime now);
  /// What the acknowledgement of a lane that is not reliable tells; the same as Flight::on_ack.
  Flight::News on_single_ack(const Ack& ack, nanoseconds came_after, HostTime now);
  /// Probes that may still arrive.
  [[nodiscard]] std::size_t probes_on_the_way(HostTime now) const;
  /// How many bytes of bulk may be on the way: twice what the link holds, so that it never runs dry.
  [[nodiscard]] std::size_t window_bytes() const;

  BandwidthEstimator estimator;
  Prober prober;

 private:
  BandwidthConfig bandwidth_;
  ProbeConfig probe_;
  std::uint64_t session_ = 0;  ///< 0: none yet
  std::uint64_t former_session_ = 0;
  static constexpr std::uint32_t kRemembered = 32;
  struct Sent {
    std::uint32_t train = 0;
    HostTime at{};
  };
  std::array<Sent, kRemembered> heartbeats_;
  std::array<Sent, kRemembered> probes_;
  std::uint32_t last_heartbeat_came_ = 0;
  std::uint32_t last_probe_sent_ = 0;
  std::uint32_t last_probe_came_ = 0;
  HostTime last_probe_at_{};
};

}  // namespace edgesplat::link
