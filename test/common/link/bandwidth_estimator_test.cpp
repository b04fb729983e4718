// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/bandwidth_estimator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <random>

namespace edgesplat::link {
namespace {

constexpr double kMbit = 1e6 / 8.0;

/// A queue in front of a link whose rate is a function of time, with noise on each chunk's time, and a sender
/// that keeps at most `window` bytes on the way.
class Trace {
 public:
  using Rate = std::function<double(double)>;
  Trace(Rate rate, double noise, std::size_t chunk_bytes)
      : rate_(std::move(rate)), noise_(noise), chunk_bytes_(chunk_bytes) {}

  /// `offered(t)`: bytes a second that the application wants to send; a great number: as much as goes.
  void run(double from_s, double to_s, const std::function<double(double)>& offered) {
    for (t_ = from_s; t_ < to_s; t_ += 0.001) {
      credit_ = std::min(credit_ + offered(t_) * 0.001, 200e3);
      while (credit_ >= static_cast<double>(chunk_bytes_) && on_the_way() < window()) send();
      acknowledge();
      estimator.tick(now(t_), on_the_way());
      if (each) each(t_);
    }
  }

  [[nodiscard]] std::uint64_t delivered() const { return delivered_; }

  BandwidthEstimator estimator;
  std::function<void(double)> each;

 private:
  struct Chunk {
    double sent_s;
    double came_s;
  };
  static HostTime now(double t_s) { return HostTime(from_seconds(1000.0 + t_s)); }
  [[nodiscard]] std::size_t on_the_way() const { return chunks_.size() * chunk_bytes_; }
  [[nodiscard]] std::size_t window() const {
    const double estimate = estimator.bytes_per_s().value_or(1e6);
    return static_cast<std::size_t>(std::clamp(0.1 * estimate, 32e3, 2e6));
  }
  void send() {
    credit_ -= static_cast<double>(chunk_bytes_);
    const bool first = chunks_.empty();
    const double size = static_cast<double>(chunk_bytes_) * (1.0 + noise_ * dice_(random_));
    double left = size;  // through the narrow place
    double at = std::max(t_, free_s_);
    while (left > 0.0) {
      const double step = std::min(left, std::max(rate_(at), 1.0) * 0.001);
      at += step / std::max(rate_(at), 1.0);
      left -= step;
    }
    free_s_ = at;
    chunks_.push_back({t_, at + 0.005});
    estimator.on_sent(now(t_), chunk_bytes_, first, credit_ >= static_cast<double>(chunk_bytes_));
  }
  void acknowledge() {
    while (!chunks_.empty() && chunks_.front().came_s + 0.005 <= t_) {
      const Chunk chunk = chunks_.front();
      chunks_.pop_front();
      delivered_ += chunk_bytes_;
      estimator.on_round_trip(from_seconds(t_ - chunk.sent_s), now(t_));
      // The receiver's clock is another one.
      estimator.on_delivery(
          {delivered_, to_ns(HostTime(from_seconds(7.0 + chunk.came_s))), now(chunk.sent_s), on_the_way()},
          now(t_));
    }
  }

  Rate rate_;
  double noise_;
  std::size_t chunk_bytes_;
  std::deque<Chunk> chunks_;
  std::uint64_t delivered_ = 0;
  double t_ = 0.0;
  double free_s_ = 0.0;
  double credit_ = 0.0;
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> dice_{-1.0, 1.0};
};

double unlimited(double) {
  return 1e9;
}
double steps(double t_s) {
  if (t_s < 5) return 100 * kMbit;
  if (t_s < 15) return 1 * kMbit;
  if (t_s < 35) return 0.2 * kMbit;
  return 100 * kMbit;
}

class BandwidthSteps : public ::testing::TestWithParam<double> {};

TEST_P(BandwidthSteps, FollowsWithinTwoSecondsAndSettlesWithinAQuarter) {
  Trace trace(steps, GetParam(), 15360);
  double worst = 0.0;
  double worst_at = 0.0;
  trace.each = [&](double t_s) {
    const double since_step = t_s < 5 ? t_s : t_s < 15 ? t_s - 5 : t_s < 35 ? t_s - 15 : t_s - 35;
    if (since_step < 2.0) return;
    const double error = std::abs(*trace.estimator.bytes_per_s() / steps(t_s) - 1.0);
    if (error > worst) {
      worst = error;
      worst_at = t_s;
    }
  };
  trace.run(0, 40, unlimited);
  EXPECT_LT(worst, 0.25) << "at " << worst_at << " s";
}

INSTANTIATE_TEST_SUITE_P(Noise, BandwidthSteps, ::testing::Values(0.0, 0.2));

TEST(BandwidthEstimator, ASlowApplicationNeverLowersTheEstimate) {
  Trace trace([](double) { return 10 * kMbit; }, 0.0, 15360);
  trace.run(0, 3, unlimited);
  const double before = *trace.estimator.bytes_per_s();
  EXPECT_NEAR(before, 10 * kMbit, 0.1 * 10 * kMbit);
  double least = before;
  trace.each = [&](double) { least = std::min(least, *trace.estimator.bytes_per_s()); };
  trace.run(3, 30, [](double) { return 60e3; });
  EXPECT_GT(least, 0.95 * before);
}

TEST(BandwidthEstimator, BurstsOfASlowApplicationMeasureTheLink) {
  // A keyframe of four chunks every half second on a link of 2 Mbit/s that widens to 8.
  Trace trace([](double t_s) { return t_s < 10 ? 2 * kMbit : 8 * kMbit; }, 0.0, 15360);
  const auto bursts = [](double t_s) { return std::fmod(t_s, 0.5) < 0.001 ? 4 * 15360e3 : 0.0; };
  trace.run(0, 10, bursts);
  EXPECT_NEAR(*trace.estimator.bytes_per_s(), 2 * kMbit, 0.25 * 2 * kMbit);
  trace.run(10, 12, bursts);
  EXPECT_NEAR(*trace.estimator.bytes_per_s(), 8 * kMbit, 0.25 * 8 * kMbit);
}

TEST(BandwidthEstimator, ADeadLinkIsNoticedByItsSilence) {
  Trace trace([](double t_s) { return t_s < 3 ? 10 * kMbit : 1e-3; }, 0.0, 15360);
  trace.run(0, 5, unlimited);
  EXPECT_LT(*trace.estimator.bytes_per_s(), 0.8 * 60e3);
}

/// Estimates after 1.2 s without a word and after the chunk that ended it, which was sent `sent_ago_s`
/// before.
std::pair<double, double> around_a_silence(double sent_ago_s) {
  Trace trace([](double) { return 200e3; }, 0.0, 15000);
  trace.run(0.0, 3.0, unlimited);
  trace.run(3.0, 6.0, [](double) { return 0.0; });  // until all has come
  EXPECT_NEAR(*trace.estimator.bytes_per_s(), 200e3, 40e3);
  BandwidthEstimator& estimator = trace.estimator;
  const auto at = [](double t_s) { return HostTime(from_seconds(1000.0 + t_s)); };
  estimator.on_sent(at(6.0), 15000, true, false);
  for (double t_s = 6.0; t_s < 7.2; t_s += 0.1) estimator.tick(at(t_s), 15000);
  const double silent = *estimator.bytes_per_s();
  estimator.on_delivery(
      {trace.delivered() + 15000, to_ns(HostTime(from_seconds(14.2))), at(7.21 - sent_ago_s), 0}, at(7.21));
  return {silent, *estimator.bytes_per_s()};
}

// A chunk that was lost twice is silent for a second too; the third that comes at once tells the two apart.
TEST(BandwidthEstimator, ASilenceThatARepetitionEndsAtOnceWasLoss) {
  const auto [silent, after] = around_a_silence(0.01);
  EXPECT_LT(silent, 20e3);
  EXPECT_NEAR(after, 200e3, 40e3);
}
TEST(BandwidthEstimator, ASilenceThatASlowChunkEndsWasTheLink) {
  const auto [silent, after] = around_a_silence(1.21);
  EXPECT_LT(silent, 20e3);
  EXPECT_LT(after, 20e3);
}

TEST(BandwidthEstimator, MuchLossLowersAndItsEndRestores) {
  Trace trace([](double) { return 10 * kMbit; }, 0.0, 15360);
  trace.run(0, 3, unlimited);
  const double before = *trace.estimator.bytes_per_s();
  trace.each = [&](double) { trace.estimator.on_loss(1, 3); };
  trace.run(3, 4, unlimited);
  EXPECT_LT(*trace.estimator.bytes_per_s(), 0.8 * before);
  trace.each = {};
  trace.run(4, 9, unlimited);
  EXPECT_GT(*trace.estimator.bytes_per_s(), 0.95 * before);
}

TEST(BandwidthEstimator, RoundTripIsTheLeastOfTheLastTwoSecondsAndTen) {
  BandwidthEstimator estimator;
  const auto at = [](double s) { return HostTime(from_seconds(s)); };
  EXPECT_FALSE(estimator.round_trip().has_value());
  estimator.on_round_trip(std::chrono::milliseconds(10), at(0));
  estimator.on_round_trip(std::chrono::milliseconds(40), at(3));
  estimator.on_round_trip(std::chrono::milliseconds(50), at(4));
  EXPECT_EQ(*estimator.round_trip(), std::chrono::milliseconds(40));
  EXPECT_EQ(*estimator.least_round_trip(), std::chrono::milliseconds(10));
  estimator.on_round_trip(std::chrono::milliseconds(60), at(11));
  EXPECT_EQ(*estimator.least_round_trip(), std::chrono::milliseconds(40));
}

}  // namespace
}  // namespace edgesplat::link
