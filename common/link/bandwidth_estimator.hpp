// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace edgesplat::link {

struct BandwidthConfig {
  std::size_t window_samples = 10;       ///< the estimate is the largest of so many
  double stale_s = 1.0;                  ///< a sample that filled the link forgets older ones
  std::size_t sample_bytes = 15000;      ///< least in a sample ...
  double sample_s = 0.02;                ///< ... and least span, unless the burst is over
  std::size_t last_sample_bytes = 3000;  ///< least at the end of a burst
  double stall_s = 0.3;                  ///< silence beyond the round trip after which the rate falls
  double queue_delay_s = 0.1;            ///< delay over the least above which a growing one is over-use
  double over_use_factor = 0.85;
  double recovery_factor = 1.05;
  double least_correction = 0.5;  ///< delay and loss together take off no more than this
  double correction_period_s = 0.2;
  double round_trip_window_s = 10.0;
  double newest_round_trip_window_s = 2.0;
};

/// How many bytes a second the link to the peer carries, from acknowledgements alone: the largest of the last
/// ten delivery rates, where samples that the sender held down never lower it, times a correction for growing
/// delay and for loss; and the round trip. A sample is what came between two chunks of one burst over the
/// time it took by the receiver's clock (packet dispersion), or over the sending time where that was longer.
/// Pure; single-owner. Source: link-and-offload.md section 3; BBR (draft-cardwell-iccrg-bbr) for the filter,
/// GCC (RFC 8698's family) for delay and loss.
class BandwidthEstimator {
 public:
  struct Delivery {
    std::uint64_t delivered_bytes = 0;  ///< by the receiver's count
    std::int64_t came_ns = 0;           ///< when the newest chunk came, receiver's clock
    std::optional<HostTime> sent;       ///< when that chunk was sent, this clock; nothing for a repetition
    std::size_t bytes_on_the_way = 0;   ///< now
  };

  explicit BandwidthEstimator(const BandwidthConfig& config = {}) : config_(config) {}

  /// A chunk was sent. `first`: nothing was on the way before. `more_waits`: the sender has more to send now.
  void on_sent(HostTime now, std::size_t bytes, bool first, bool more_waits);
  void on_delivery(const Delivery& delivery, HostTime now);
  void on_round_trip(nanoseconds round_trip, HostTime now);
  void on_loss(std::size_t chunks_lost, std::size_t chunks_came);
  /// To be called now and then, at least every 0.2 s while bytes are on the way.
  void tick(HostTime now, std::size_t bytes_on_the_way);

  /// Nothing before the first sample.
  [[nodiscard]] std::optional<double> bytes_per_s() const;
  /// Least of the last 2 s / 10 s.
  [[nodiscard]] std::optional<nanoseconds> round_trip() const;
  [[nodiscard]] std::optional<nanoseconds> least_round_trip() const;
  /// When the estimate was last confirmed: a sample that filled the link or raised it.
  [[nodiscard]] std::optional<HostTime> confirmed_at() const { return confirmed_at_; }
  [[nodiscard]] double correction() const { return correction_; }

 private:
  struct Point {
    std::uint64_t delivered_bytes;
    std::int64_t came_ns;
    HostTime sent;
  };
  struct Sample {
    double bytes_per_s;
    HostTime at;
  };
  struct RoundTrip {
    nanoseconds value;
    HostTime at;
  };
  [[nodiscard]] bool ran_dry_between(HostTime from, HostTime to) const;
  void take_sample(const Point& from, const Point& to, HostTime now);
  void add_sample(double bytes_per_s, bool filled_the_link, HostTime now);
  void end_silence(const Delivery& delivery, HostTime now);
  void watch_delay(const Point& point, HostTime now);
  void correct(HostTime now);
  [[nodiscard]] double largest() const;
  /// Mean of the newest samples over the largest.
  [[nodiscard]] double newest_share() const;

  BandwidthConfig config_;
  std::optional<Point> base_;
  std::deque<HostTime> ran_dry_;  ///< when the sender had no more to send, the last few times
  HostTime burst_began_{};
  std::deque<Sample> samples_;
  std::deque<Sample> before_silence_;  ///< what samples_ held; empty while it is not silent
  std::deque<RoundTrip> round_trips_;
  std::optional<HostTime> confirmed_at_;
  std::uint64_t last_delivered_bytes_ = 0;
  HostTime progress_at_{};
  std::size_t largest_chunk_bytes_ = 0;
  std::optional<double> least_delay_s_;  ///< receiver's minus this clock: only differences mean something
  HostTime least_delay_at_{};
  std::optional<double> last_delay_s_;
  int growing_in_a_row_ = 0;
  bool over_use_ = false;
  std::size_t lost_ = 0;
  std::size_t came_ = 0;
  double correction_ = 1.0;
  HostTime corrected_at_{};
};

}  // namespace edgesplat::link
