// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/local_map.hpp"

#include "common/metrics/process_usage.hpp"
#include "test/robot/local_mapping/facing_wall.hpp"

#include <gtest/gtest.h>

#include <set>

namespace edgesplat::local_mapping {
namespace {

constexpr map::RobotId kRobot{7};

struct Maker {
  explicit Maker(const LocalMappingConfig& config = {}) : local(*LocalMap::create(config, kRobot, clock)) {}
  SteadyClock clock;
  LocalMap local;

  [[nodiscard]] std::set<std::uint32_t> anchors() const {
    std::set<std::uint32_t> keyframes;
    for (const auto& anchor : local.cloud().anchors) keyframes.insert(anchor.keyframe);
    return keyframes;
  }
};

TEST(LocalMap, GrowsInLocalAlone) {
  Maker maker;
  maker.local.add(*test::facing_wall(1));
  EXPECT_EQ(maker.local.cloud().size(), 0U);
  maker.local.set_here(true);
  maker.local.add(*test::facing_wall(2));
  const std::size_t grown = maker.local.cloud().size();
  EXPECT_GT(grown, 500U);
  EXPECT_TRUE(maker.local.has_work());
  maker.local.set_here(false);
  maker.local.add(*test::facing_wall(3, 20.0));
  maker.local.step();
  EXPECT_EQ(maker.local.cloud().size(), grown);
  EXPECT_FALSE(maker.local.has_work());
  EXPECT_EQ(maker.local.counters().steps, 0U);
  EXPECT_EQ(maker.anchors(), std::set<std::uint32_t>{2});
}

TEST(LocalMap, GaussiansAreNamedAfterTheRobotAndNeverAlike) {
  Maker maker;
  std::set<std::uint64_t> names;
  maker.local.set_here(true);
  maker.local.add(*test::facing_wall(1));
  for (const auto& id : maker.local.cloud().ids) {
    EXPECT_EQ(id.origin(), kRobot.value);
    EXPECT_TRUE(names.insert(id.packed()).second);
  }
  maker.local.retire(std::vector<std::uint32_t>{1});
  maker.local.set_here(false);
  maker.local.set_here(true);
  maker.local.add(*test::facing_wall(2));
  ASSERT_GT(maker.local.cloud().size(), 500U);
  for (const auto& id : maker.local.cloud().ids) EXPECT_TRUE(names.insert(id.packed()).second);
}

TEST(LocalMap, StepsMakeItLikeThePicture) {
  Maker maker;
  const auto wall = test::facing_wall(1);
  maker.local.set_here(true);
  maker.local.add(*wall);
  const double before = test::picture_error(maker.local.cloud(), *wall);
  for (int i = 0; i < 40; ++i) maker.local.step();
  EXPECT_EQ(maker.local.counters().steps, 40U);
  EXPECT_LT(test::picture_error(maker.local.cloud(), *wall), 0.5 * before);
}

TEST(LocalMap, GoesOnWhereItStoppedWhenLocalComesAgain) {
  Maker maker;
  maker.local.set_here(true);
  maker.local.add(*test::facing_wall(1));
  const auto ids = maker.local.cloud().ids;
  maker.local.set_here(false);
  maker.local.set_here(true);
  EXPECT_EQ(maker.local.cloud().ids, ids);
  maker.local.add(*test::facing_wall(1));  // the same wall is there
  EXPECT_LT(maker.local.cloud().size(), ids.size() * 21 / 20);
}

TEST(LocalMap, LeavesWhatTheServerMapped) {
  Maker other, maker;
  other.local.set_here(true);
  other.local.add(*test::facing_wall(1));
  maker.local.set_resident(std::make_shared<const gaussian::GaussianCloud>(other.local.cloud()));
  maker.local.set_here(true);
  maker.local.add(*test::facing_wall(2));
  EXPECT_LT(maker.local.cloud().size(), other.local.cloud().size() / 20);
  maker.local.add(*test::facing_wall(3, 20.0));
  EXPECT_GT(maker.local.cloud().size(), 500U);
}

TEST(LocalMap, DoesNotTrainOnWhatTheServersGaussiansFill) {
  Maker other, maker;
  other.local.set_here(true);
  other.local.add(*test::facing_wall(1));
  const auto steps_move = [](LocalMap& local) {
    const auto before = local.cloud().sh;
    for (int i = 0; i < 10; ++i) local.step();
    double moved = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      moved += std::abs(static_cast<double>(local.cloud().sh[i] - before[i]));
    return moved / static_cast<double>(before.size());
  };
  maker.local.set_here(true);
  maker.local.set_resident(std::make_shared<const gaussian::GaussianCloud>(other.local.cloud()));
  maker.local.add(*test::facing_wall(2, 0.0, 3000, 9));  // between the server's Gaussians
  ASSERT_GT(maker.local.cloud().size(), 500U);
  EXPECT_LT(steps_move(maker.local), 0.1 * steps_move(other.local));
}

TEST(LocalMap, KeepsItsBudgetAndWhatIsNear) {
  LocalMappingConfig config;
  config.budget_bytes = std::size_t{1} << 20U;
  Maker maker(config);
  maker.local.set_here(true);
  EXPECT_LT(maker.local.room(), 3000U);
  for (std::uint32_t id = 1; id <= 12; ++id) {
    maker.local.add(*test::facing_wall(id, 6.0 * id));
    for (int i = 0; i < 3; ++i) maker.local.step();
    ASSERT_LE(maker.local.cloud().size(), maker.local.room());
    ASSERT_LE(maker.local.counters().views * 64 * 48 * 3, config.view_bytes());
    EXPECT_TRUE(maker.anchors().contains(id)) << "the newest is there";
  }
  EXPECT_GT(maker.local.counters().pruned, 500U);
  EXPECT_FALSE(maker.anchors().contains(1)) << "the oldest, 66 m away, is gone";
}

TEST(LocalMap, PruningShrinksItStepByStepDownToAFloor) {
  LocalMappingConfig config;
  config.budget_bytes = std::size_t{8} << 20U;
  config.views_when_short = 2;
  Maker maker(config);
  maker.local.set_here(true);
  for (std::uint32_t id = 1; id <= 5; ++id) maker.local.add(*test::facing_wall(id, 6.0 * id));
  const std::size_t grown = maker.local.cloud().size();
  ASSERT_GT(grown, maker.local.room() / 5);
  EXPECT_EQ(maker.local.counters().views, 5U);
  maker.local.prune_and_compress();
  EXPECT_LE(maker.local.cloud().size(), std::max(grown * 4 / 5, maker.local.room() / 20));
  EXPECT_EQ(maker.local.counters().views, 2U);
  EXPECT_EQ(maker.local.counters().dropped_views, 3U);
  EXPECT_TRUE(maker.local.has_work());
  for (int i = 0; i < 20; ++i) maker.local.prune_and_compress();
  EXPECT_EQ(maker.local.cloud().size(), maker.local.room() / 20);
  EXPECT_EQ(maker.local.counters().pruned, grown - maker.local.room() / 20);
  EXPECT_TRUE(maker.anchors().contains(5));
  // The same where the Gaussians only wait for the server.
  maker.local.add(*test::facing_wall(6, 60.0));
  maker.local.set_here(false);
  const std::size_t waiting = maker.local.cloud().size();
  maker.local.prune_and_compress();
  EXPECT_LT(maker.local.cloud().size(), waiting);
}

TEST(LocalMap, PruningGivesMemoryBackToTheSystem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer keeps what is freed";
#endif
  Maker maker;
  maker.local.set_here(true);
  for (std::uint32_t id = 1; id <= 12; ++id) maker.local.add(*test::facing_wall(id, 6.0 * id, 20000));
  for (int i = 0; i < 12; ++i) maker.local.step();
  ASSERT_GT(maker.local.cloud().size(), 40000U);
  const auto before_bytes = metrics::process_usage().rss_bytes;
  for (int i = 0; i < 4; ++i) maker.local.prune_and_compress();
  const auto after_bytes = metrics::process_usage().rss_bytes;
  RecordProperty("freed_bytes", std::to_string(before_bytes - after_bytes));
  EXPECT_LT(after_bytes + (std::size_t{4} << 20U), before_bytes);
}

TEST(LocalMap, RetiresWhatTheServerMappedAndNothingElse) {
  test::Random random(5);
  Maker maker;
  maker.local.set_here(true);
  std::set<std::uint32_t> here;
  std::uint32_t next = 1;
  for (int round = 0; round < 60; ++round) {
    if (random.below(2) == 0) {
      maker.local.add(*test::facing_wall(next, 6.0 * next, 600));
      if (maker.local.here()) here.insert(next);
      ++next;
    }
    if (random.below(5) == 0) maker.local.set_here(!maker.local.here());
    if (random.below(3) == 0) maker.local.step();
    std::vector<std::uint32_t> mapped;  // some of those that came before, in any order, also twice
    for (std::uint32_t id = 1; id < next; ++id) {
      if (random.below(8) == 0) mapped.push_back(id);
    }
    maker.local.retire(mapped);
    for (const std::uint32_t id : mapped) here.erase(id);
    ASSERT_EQ(maker.anchors(), here) << "round " << round;
  }
  EXPECT_GT(maker.local.counters().retired, 1000U);
}

TEST(LocalMap, DoesNotMapAKeyframeThatTheServerMappedFirst) {
  Maker maker;
  maker.local.set_here(true);
  maker.local.retire(std::vector<std::uint32_t>{4, 5});
  maker.local.add(*test::facing_wall(3));
  maker.local.add(*test::facing_wall(4, 20.0));
  maker.local.add(*test::facing_wall(6, 40.0));
  EXPECT_EQ(maker.anchors(), (std::set<std::uint32_t>{3, 6}));
}

TEST(LocalMap, UsesThePointsOfAKeyframeWhosePictureIsDamaged) {
  Maker maker;
  maker.local.set_here(true);
  map::Keyframe keyframe = *test::facing_wall(1);
  auto broken = std::make_shared<map::EncodedImage>(*keyframe.image);
  broken->bytes.resize(40);
  keyframe.image = broken;
  maker.local.add(keyframe);
  EXPECT_GT(maker.local.cloud().size(), 500U);
  EXPECT_EQ(maker.local.counters().bad_pictures, 1U);
}

}  // namespace
}  // namespace edgesplat::local_mapping
