// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/local_mapper.hpp"

#include "test/robot/local_mapping/facing_wall.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace edgesplat::local_mapping {
namespace {

using Cloud = std::shared_ptr<const gaussian::GaussianCloud>;

struct Maker {
  explicit Maker(Pace pace, const LocalMappingConfig& config = {}) {
    mapper = *LocalMapper::create(
        config, map::RobotId{7}, pace,
        [this](Cloud made) {
          const std::lock_guard lock(mutex);
          newest = std::move(made);
        },
        clock, registry);
  }
  [[nodiscard]] Cloud settled() {
    EXPECT_TRUE(mapper->settle(std::chrono::seconds(30)));
    const std::lock_guard lock(mutex);
    return newest;
  }
  [[nodiscard]] std::uint64_t count(const std::string& name) const {
    metrics::Registry counters;
    mapper->publish_counters(counters);
    return counters.counter(name).value();
  }

  SteadyClock clock;
  metrics::Registry registry;
  std::mutex mutex;
  Cloud newest;
  std::unique_ptr<LocalMapper> mapper;
};

class BothPaces : public testing::TestWithParam<Pace> {};

TEST_P(BothPaces, MapsInLocalKeepsAfterwardsAndRetires) {
  Maker maker(GetParam());
  maker.mapper->submit(test::facing_wall(1));
  EXPECT_EQ(maker.settled(), nullptr);
  maker.mapper->set_work(true, false);
  maker.mapper->submit(test::facing_wall(2));
  const Cloud grown = maker.settled();
  ASSERT_NE(grown, nullptr);
  EXPECT_GT(grown->size(), 500U);
  maker.mapper->set_work(false, false);
  maker.mapper->submit(test::facing_wall(3, 20.0));
  maker.mapper->retire({3, 1});
  EXPECT_EQ(maker.settled()->size(), grown->size());
  maker.mapper->retire({2});
  EXPECT_EQ(maker.settled()->size(), 0U);
  EXPECT_EQ(maker.count("local.keyframes"), 1U);
  EXPECT_EQ(maker.count("local.retired"), grown->size());
}

TEST_P(BothPaces, PrunesWhenTold) {
  LocalMappingConfig config;
  config.budget_bytes = std::size_t{4} << 20U;
  Maker maker(GetParam(), config);
  maker.mapper->set_work(true, false);
  maker.mapper->submit(test::facing_wall(1));
  const std::size_t grown = maker.settled()->size();
  maker.mapper->set_work(true, true);
  maker.mapper->set_work(true, false);
  const std::size_t pruned = maker.settled()->size();
  EXPECT_LT(pruned, grown);
  EXPECT_EQ(maker.count("local.pruned"), grown - pruned);
}

INSTANTIATE_TEST_SUITE_P(LocalMapper, BothPaces, testing::Values(Pace::kOwnThread, Pace::kInline));

TEST(LocalMapper, ALockstepRunIsRepeatable) {
  const auto run = [] {
    Maker maker(Pace::kInline);
    maker.mapper->set_work(true, false);
    for (std::uint32_t id = 1; id < 6; ++id) maker.mapper->submit(test::facing_wall(id, 1.5 * id));
    return maker.settled();
  };
  const Cloud first = run();
  const Cloud second = run();
  EXPECT_EQ(first->ids, second->ids);
  EXPECT_EQ(first->means_m, second->means_m);
  EXPECT_EQ(first->sh, second->sh);
}

TEST(LocalMapper, StepsByItselfWithinItsShareOfACore) {
  LocalMappingConfig config;
  config.core_share = 0.2;
  Maker maker(Pace::kOwnThread, config);
  maker.mapper->set_work(true, false);
  const auto wall = test::facing_wall(1);
  const HostTime start = maker.clock.now();
  maker.mapper->submit(wall);
  while (maker.count("local.steps") <= 5 && maker.clock.now() - start < std::chrono::seconds(30))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const Cloud made = maker.settled();
  const double passed_ms = to_seconds(maker.clock.now() - start) * 1e3;
  EXPECT_GT(maker.count("local.steps"), 5U);
  double worked_ms = 0.0;
  double longest_ms = 0.0;
  for (const char* name : {"local.step_ms", "local.keyframe_ms"}) {
    const auto summary = maker.registry.histogram(name).summary();
    worked_ms += summary.mean * static_cast<double>(summary.count);
    longest_ms = std::max(longest_ms, summary.max);
  }
  // A piece of work is followed by its rest: only the last may lack it.
  EXPECT_LT(worked_ms - longest_ms, config.core_share * passed_ms);
}

TEST(LocalMapper, NoCallWaitsForTheMapping) {
  Maker maker(Pace::kOwnThread);
  maker.mapper->set_work(true, false);
  std::vector<std::shared_ptr<const map::Keyframe>> keyframes;
  for (std::uint32_t id = 1; id <= 40; ++id) keyframes.push_back(test::facing_wall(id, 6.0 * id, 20000));
  const HostTime start = maker.clock.now();
  for (const auto& keyframe : keyframes) {
    maker.mapper->submit(keyframe);
    maker.mapper->set_work(true, false);
    maker.mapper->retire({keyframe->id.value + 1000});
  }
  const double calls_ms = to_seconds(maker.clock.now() - start) * 1e3;
  (void)maker.settled();
  const auto mapped = maker.registry.histogram("local.keyframe_ms").summary();
  EXPECT_GE(maker.count("local.dropped"), 40U - 8U - mapped.count);
  EXPECT_EQ(maker.count("local.dropped") + maker.count("local.keyframes"), 40U);
  EXPECT_LT(calls_ms, mapped.mean * static_cast<double>(mapped.count));
}

}  // namespace
}  // namespace edgesplat::local_mapping
