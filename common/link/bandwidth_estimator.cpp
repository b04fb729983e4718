// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/bandwidth_estimator.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {
namespace {

constexpr double kLeastSpan_s = 1e-3;    // shorter ones say more about scheduling than about the link
constexpr double kSenderHeldDown = 0.7;  // sending took this much of the span: the link may carry more
constexpr double kNewRegime = 0.7;       // the filter fell below this: what was corrected is seen directly
constexpr std::size_t kLossChunks = 20;  // fewer say nothing about a rate of loss
constexpr double kMuchLoss = 0.1;
constexpr double kLittleLoss = 0.02;
constexpr int kGrowingSamples = 2;
constexpr std::size_t kNewestSamples = 3;
constexpr std::size_t kRememberedDrySpells = 64;

}  // namespace

void BandwidthEstimator::on_sent(HostTime now, std::size_t bytes, bool first, bool more_waits) {
  if (first) {
    base_.reset();
    burst_began_ = now;
    progress_at_ = now;
    last_delay_s_.reset();
    growing_in_a_row_ = 0;
  }
  if (!more_waits) {
    ran_dry_.push_back(now);
    if (ran_dry_.size() > kRememberedDrySpells) ran_dry_.pop_front();
  }
  largest_chunk_bytes_ = std::max(largest_chunk_bytes_, bytes);
}

void BandwidthEstimator::on_delivery(const Delivery& d, HostTime now) {
  if (d.delivered_bytes <= last_delivered_bytes_) {
    // An old report, or a receiver that counts anew.
    if (d.delivered_bytes + largest_chunk_bytes_ * 64 < last_delivered_bytes_) {
      last_delivered_bytes_ = d.delivered_bytes;
      base_.reset();
    }
    return;
  }
  last_delivered_bytes_ = d.delivered_bytes;
  progress_at_ = now;
  end_silence(d, now);
  if (!d.sent || *d.sent < burst_began_) return;
  const Point point{d.delivered_bytes, d.came_ns, *d.sent};
  if (!base_) {
    base_ = point;
    return;
  }
  const auto bytes = static_cast<std::size_t>(point.delivered_bytes - base_->delivered_bytes);
  const bool over = d.bytes_on_the_way == 0;
  const bool long_enough = static_cast<double>(point.came_ns - base_->came_ns) * 1e-9 >= config_.sample_s;
  if ((bytes >= config_.sample_bytes && long_enough) || (over && bytes >= config_.last_sample_bytes)) {
    take_sample(*base_, point, now);
    base_ = point;
  }
}

void BandwidthEstimator::end_silence(const Delivery& d, HostTime now) {
  if (before_silence_.empty()) return;
  const double patience_s = config_.stall_s + to_seconds(round_trip().value_or(nanoseconds(0)));
  // A repetition that came at once: what was sent before was lost, not slow.
  if (d.sent && to_seconds(now - *d.sent) < patience_s) samples_ = before_silence_;
  before_silence_.clear();
}

bool BandwidthEstimator::ran_dry_between(HostTime from, HostTime to) const {
  return std::any_of(ran_dry_.begin(), ran_dry_.end(), [&](HostTime t) { return t >= from && t < to; });
}

void BandwidthEstimator::take_sample(const Point& from, const Point& to, HostTime now) {
  const auto bytes = static_cast<double>(to.delivered_bytes - from.delivered_bytes);
  const double came_s = static_cast<double>(to.came_ns - from.came_ns) * 1e-9;
  const double sent_s = to_seconds(to.sent - from.sent);
  const double span_s = std::max({came_s, sent_s, kLeastSpan_s});
  const bool saturated = !ran_dry_between(from.sent, to.sent);
  const bool filled = came_s >= kLeastSpan_s && (saturated || sent_s < kSenderHeldDown * came_s);
  if (saturated) watch_delay(to, now);
  add_sample(bytes / span_s, filled, now);
}

void BandwidthEstimator::add_sample(double bytes_per_s, bool filled_the_link, HostTime now) {
  const double before = largest();
  if (!filled_the_link && bytes_per_s <= before) return;
  confirmed_at_ = now;
  samples_.push_back({bytes_per_s, now});
  if (samples_.size() > config_.window_samples) samples_.pop_front();
  if (filled_the_link) {
    while (now - samples_.front().at > from_seconds(config_.stale_s)) samples_.pop_front();
  }
  if (largest() < kNewRegime * before) correction_ = 1.0;
}

double BandwidthEstimator::largest() const {
  double most = 0.0;
  for (const Sample& sample : samples_) most = std::max(most, sample.bytes_per_s);
  return most;
}

double BandwidthEstimator::newest_share() const {
  const std::size_t count = std::min(samples_.size(), kNewestSamples);
  if (count == 0) return 1.0;
  double sum = 0.0;
  for (std::size_t i = samples_.size() - count; i < samples_.size(); ++i) sum += samples_[i].bytes_per_s;
  return sum / static_cast<double>(count) / largest();
}

void BandwidthEstimator::watch_delay(const Point& point, HostTime now) {
  const double delay_s = static_cast<double>(point.came_ns - to_ns(point.sent)) * 1e-9;
  const bool expired = now - least_delay_at_ > from_seconds(config_.round_trip_window_s);
  if (!least_delay_s_ || expired || delay_s < *least_delay_s_) {
    least_delay_s_ = delay_s;
    least_delay_at_ = now;
  }
  const bool grows = last_delay_s_ && delay_s > *last_delay_s_ + 0.1 * config_.queue_delay_s;
  growing_in_a_row_ = grows && delay_s - *least_delay_s_ > config_.queue_delay_s ? growing_in_a_row_ + 1 : 0;
  if (growing_in_a_row_ >= kGrowingSamples) over_use_ = true;
  last_delay_s_ = delay_s;
}

void BandwidthEstimator::on_loss(std::size_t chunks_lost, std::size_t chunks_came) {
  lost_ += chunks_lost;
  came_ += chunks_came;
}

void BandwidthEstimator::on_round_trip(nanoseconds round_trip, HostTime now) {
  // A falling staircase: what a newer and smaller one covers is gone, so the front is the least.
  while (!round_trips_.empty() && round_trips_.back().value >= round_trip) round_trips_.pop_back();
  round_trips_.push_back({round_trip, now});
  while (now - round_trips_.front().at > from_seconds(config_.round_trip_window_s)) round_trips_.pop_front();
}

void BandwidthEstimator::tick(HostTime now, std::size_t bytes_on_the_way) {
  if (bytes_on_the_way > 0 && !samples_.empty()) {
    const double silence_s =
        to_seconds(now - progress_at_) - to_seconds(round_trip().value_or(nanoseconds(0)));
    const double most = static_cast<double>(largest_chunk_bytes_) / std::max(silence_s, 1e-9);
    // Not one chunk came in all that time.
    if (silence_s > config_.stall_s && most < largest()) {
      if (before_silence_.empty()) before_silence_ = samples_;
      samples_.clear();
      samples_.push_back({most, now});
      correction_ = 1.0;
    }
  }
  if (now - corrected_at_ >= from_seconds(config_.correction_period_s)) correct(now);
}

void BandwidthEstimator::correct(HostTime now) {
  corrected_at_ = now;
  const bool counts = lost_ + came_ >= kLossChunks;
  const double loss = counts ? static_cast<double>(lost_) / static_cast<double>(lost_ + came_) : 0.0;
  double factor = 1.0;
  double least = config_.least_correction;
  if (std::exchange(over_use_, false)) {
    factor = config_.over_use_factor;
    least = std::max(least, newest_share());  // what just came through is there
  } else if (loss > kMuchLoss) {
    factor = 1.0 - 0.5 * loss;
  } else if (loss < kLittleLoss) {
    factor = config_.recovery_factor;
  }
  correction_ = std::clamp(correction_ * factor, std::min(least, 1.0), 1.0);
  if (counts) lost_ = came_ = 0;
}

std::optional<double> BandwidthEstimator::bytes_per_s() const {
  if (samples_.empty()) return std::nullopt;
  return largest() * correction_;
}

std::optional<nanoseconds> BandwidthEstimator::least_round_trip() const {
  if (round_trips_.empty()) return std::nullopt;
  return round_trips_.front().value;
}

std::optional<nanoseconds> BandwidthEstimator::round_trip() const {
  if (round_trips_.empty()) return std::nullopt;
  const HostTime newest = round_trips_.back().at;
  for (const RoundTrip& sample : round_trips_) {
    if (newest - sample.at <= from_seconds(config_.newest_round_trip_window_s)) return sample.value;
  }
  return round_trips_.back().value;
}

}  // namespace edgesplat::link
