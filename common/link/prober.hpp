// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <optional>

namespace edgesplat::link {

struct ProbeConfig {
  std::size_t packets = 16;
  std::size_t least_packets = 4;
  std::size_t packet_bytes = 1200;
  double period_s = 5.0;  ///< between two trains, and the age above which an estimate is measured again
  double share = 0.02;    ///< of the estimated link, at most
  double first_bytes_per_s = 375e3;  ///< taken for the estimate while there is none
};

/// When to send padding so that the bandwidth is known while nothing else is sent: a train of packets at
/// twice the estimate. Narrow links get shorter trains further apart, so that at most `share` of them is
/// used. Pure; single-owner.
class Prober {
 public:
  struct Situation {
    bool allowed = false;  ///< a decision depends on the estimate, and somebody listens
    bool idle = false;     ///< nothing waits and nothing is on its way
    std::optional<double> bytes_per_s;
    std::optional<HostTime> confirmed_at;  ///< when the estimate was last confirmed
  };

  explicit Prober(const ProbeConfig& config = {}) : config_(config) {}
  /// True: send one packet now, then ask again.
  bool due(const Situation& situation, HostTime now);
  /// When due() may next be true by time alone; meaningful after due() returned false.
  [[nodiscard]] std::optional<HostTime> next_event() const { return next_; }
  [[nodiscard]] const ProbeConfig& config() const { return config_; }
  [[nodiscard]] bool more_follows() const { return left_ > 0; }
  /// The packet that due() just allowed begins a train.
  [[nodiscard]] bool begins_train() const { return begins_train_; }

 private:
  [[nodiscard]] HostTime next_train(const Situation& situation) const;
  void begin(const Situation& situation, HostTime now);

  ProbeConfig config_;
  std::size_t left_ = 0;
  bool begins_train_ = false;
  nanoseconds gap_{};
  nanoseconds pause_{};
  HostTime packet_at_{};
  std::optional<HostTime> last_train_;
  std::optional<HostTime> next_;
};

}  // namespace edgesplat::link
