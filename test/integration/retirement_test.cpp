// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Gaussians that the robot made itself go when the server's take their place: never before those are there,
// and always after, whatever the network and the server's process do.
#include "robot/local_mapping/local_map.hpp"
#include "robot/map/resident_map.hpp"
#include "server/stream/delta_stream.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/integration/delta_faults.hpp"
#include "test/robot/local_mapping/facing_wall.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <set>

namespace edgesplat {
namespace {

constexpr double kStep_s = 0.01;
constexpr test::Faults kBad{0.05, 0.03, 0.01, 0.01, 0.08};
constexpr std::uint32_t kKeyframes = 60;
constexpr std::size_t kRowsEach = 40;

/// The robot makes a keyframe now and then and maps it itself; the server gets it later or never, and maps
/// it.
class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : random_(seed),
        down_(kBad, seed + 1),
        up_(kBad, seed + 2),
        own_(*local_mapping::LocalMap::create({}, map::RobotId{1}, clock_)) {
    own_.set_here(true);
    start_server();
  }
  /// Another process, from what was saved: all that was mapped `forgotten` keyframes ago.
  void start_server(std::size_t forgotten = 0) {
    while (forgotten-- > 0 && !mapped_order_.empty()) forget(mapped_order_.back());
    stream::DeltaStreamConfig config;
    config.robot.value = 1;
    config.map = map_;
    config.epoch.value = ++epoch_;
    config.max_rows = 30;
    config.window_bytes = 20000;
    stream_ = std::make_unique<stream::DeltaStream>(config);
    map::MapRequest everything;
    everything.robot.value = 1;
    (void)stream_->answer(everything, now_);
    stream_->mapped(mapped_order_);
    publish(all_rows());
  }
  void step() {
    now_ += from_seconds(kStep_s);
    ++steps_;
    if (steps_ % 10 == 0 && next_ < kKeyframes) make_keyframe();
    if (random_.below(8) == 0) map_one();
    if (steps_ % 5 == 0) publish({});
    exchange();
    if (steps_ % 3 == 0) check();
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kStep_s); ++i) step();
  }
  /// Maps what is left but for what the spool dropped, then lets the network come to rest.
  void finish() {
    while (!spooled_.empty()) map_one();
    run(8.0);
  }

  [[nodiscard]] std::set<std::uint32_t> drawn_of_the_robots_own() const {
    std::set<std::uint32_t> keyframes;
    for (const auto& anchor : own_.cloud().anchors) keyframes.insert(anchor.keyframe);
    return keyframes;
  }
  /// Never mapped, or forgotten by a server that had not told yet.
  [[nodiscard]] std::set<std::uint32_t> lost() const {
    std::set<std::uint32_t> keyframes = lost_;
    std::erase_if(keyframes, [this](std::uint32_t id) { return told_.contains(id); });
    return keyframes;
  }
  [[nodiscard]] std::size_t server_gaussians() const { return cloud_.size(); }
  [[nodiscard]] const map::ResidentMap& resident() const { return resident_; }
  [[nodiscard]] std::size_t checked() const { return checked_; }

 private:
  [[nodiscard]] std::vector<std::uint32_t> all_rows() const {
    std::vector<std::uint32_t> rows(cloud_.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
  }
  void make_keyframe() {
    const std::uint32_t id = next_++;
    own_.add(*test::facing_wall(id, 6.0 * id, 300));
    if (random_.below(10) == 0) {
      lost_.insert(id);  // over the spool's cap
    } else {
      spooled_.push_back(id);
    }
  }
  /// The server gets one, not in order, and maps it.
  void map_one() {
    if (spooled_.empty()) return;
    const auto which = spooled_.begin() + static_cast<std::ptrdiff_t>(random_.below(spooled_.size()));
    const std::uint32_t id = *which;
    spooled_.erase(which);
    auto rows = test::random_gaussians(kRowsEach, 1000 + id);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      rows.ids[row] = gaussian::GaussianId(40000, ++ids_);
      rows.anchors[row] = {id, 0};
      cloud_.append_row(rows, row);
    }
    std::vector<std::uint32_t> changed(kRowsEach);
    std::iota(changed.begin(), changed.end(), static_cast<std::uint32_t>(cloud_.size() - kRowsEach));
    mapped_order_.push_back(id);
    stream_->mapped(std::span(&id, 1));
    publish(changed);
  }
  void forget(std::uint32_t id) {
    gaussian::GaussianCloud rest;
    for (std::size_t row = 0; row < cloud_.size(); ++row)
      if (cloud_.anchors[row].keyframe != id) rest.append_row(cloud_, row);
    cloud_ = std::move(rest);
    mapped_order_.pop_back();
    lost_.insert(id);
  }
  void publish(const std::vector<std::uint32_t>& changed) {
    for (auto& delta : stream_->publish(cloud_, changed, {}, 1500)) down_.send(std::move(delta), now_);
  }
  void exchange() {
    for (const auto& bytes : up_.arrived(now_)) {
      const auto request = map::decode_map_request(bytes);
      if (!request) continue;
      for (auto& delta : stream_->answer(*request, now_)) down_.send(std::move(delta), now_);
    }
    for (const auto& bytes : down_.arrived(now_)) (void)resident_.apply(bytes, now_);
    resident_.publish_if_due(now_);
    retire();
    if (steps_ % 20 == 0) {
      const auto at = stream_->position();
      resident_.server_at({map::Epoch{epoch_}, at.seq}, at.map_hash, true, now_);
    }
    for (const auto& request : resident_.requests(now_)) up_.send(encode_map_request(request), now_);
  }
  void retire() {
    const auto mapped = resident_.take_mapped();
    const auto drawn = resident_.snapshot();
    std::map<std::uint32_t, std::size_t> rows_of;
    for (const auto& anchor : drawn->anchors) ++rows_of[anchor.keyframe];
    // Not before: all that the server made of it is drawn.
    for (const std::uint32_t id : mapped) {
      EXPECT_EQ(rows_of[id], kRowsEach) << "keyframe " << id;
      told_.insert(id);
    }
    own_.retire(mapped);
  }
  /// What was told is gone, and nothing else is.
  void check() {
    const auto own = drawn_of_the_robots_own();
    for (std::uint32_t id = 0; id < next_; ++id) ASSERT_EQ(own.contains(id), !told_.contains(id)) << id;
    ++checked_;
  }

  SteadyClock clock_;
  test::Random random_;
  HostTime now_{};
  int steps_ = 0;
  std::uint32_t next_ = 0;
  std::uint32_t epoch_ = 0;
  std::uint64_t ids_ = 0;
  map::MapUuid map_ = stream::make_map_uuid();
  gaussian::GaussianCloud cloud_;
  std::vector<std::uint32_t> spooled_, mapped_order_;
  std::set<std::uint32_t> lost_, told_;
  std::unique_ptr<stream::DeltaStream> stream_;
  test::FaultyWay down_, up_;
  map::ResidentMap resident_{map::ResidentMapConfig{}};
  local_mapping::LocalMap own_;
  std::size_t checked_ = 0;
};

class Retirement : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Retirement, OverABadNetwork) {
  Bench bench(GetParam());
  bench.run(8.0);
  bench.finish();
  EXPECT_EQ(bench.drawn_of_the_robots_own(), bench.lost());  // what will never come stays
  EXPECT_EQ(bench.resident().snapshot()->size(), bench.server_gaussians());
  EXPECT_GT(bench.checked(), 300U);
}

TEST_P(Retirement, WithTheServerStartedAnewInBetween) {
  Bench bench(GetParam());
  for (int round = 0; round < 4; ++round) {
    bench.run(1.7);
    bench.start_server(round % 2 == 0 ? 0 : 3);
  }
  bench.finish();
  EXPECT_EQ(bench.drawn_of_the_robots_own(), bench.lost());
  EXPECT_EQ(bench.resident().snapshot()->size(), bench.server_gaussians());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Retirement, ::testing::Range(std::uint64_t{1}, std::uint64_t{5}));

}  // namespace
}  // namespace edgesplat
