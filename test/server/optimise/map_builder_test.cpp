// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

#include "common/io/image_file.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

namespace edgesplat::optimise {
namespace {

struct Maker {
  SteadyClock clock;
  mapping::IdAllocator ids{40000};
  std::unique_ptr<MapBuilder> builder = *MapBuilder::create({}, ids, clock);
};

TEST(MapBuilder, AppendsSeededGaussiansAndNamesTheirRows) {
  Maker maker;
  std::uint32_t total = 0;
  std::set<std::uint64_t> seen;
  for (std::uint32_t id = 0; id < 5; ++id) {
    const std::size_t added = maker.builder->add(test::random_keyframe(id, 3000, id));
    const auto& cloud = maker.builder->engine().cloud();
    const auto changes = maker.builder->take_changes();
    ASSERT_TRUE(cloud.consistent());
    ASSERT_EQ(changes.changed_rows.size(), added);
    for (const std::uint32_t row : changes.changed_rows) {
      EXPECT_EQ(row, total++);
      ASSERT_LT(row, cloud.size());
      EXPECT_EQ(cloud.anchors[row].keyframe, id);
      EXPECT_EQ(cloud.anchors[row].pose_version, 2U);
      EXPECT_TRUE(seen.insert(cloud.ids[row].packed()).second);
    }
  }
  EXPECT_GT(total, 1000U);
}

TEST(MapBuilder, UsesThePointsOfAKeyframeWhosePictureIsDamaged) {
  Maker maker;
  map::Keyframe keyframe = test::random_keyframe(1, 3000, 1);
  ASSERT_TRUE(keyframe.camera.has_value());
  auto broken = std::make_shared<map::EncodedImage>();
  broken->bytes.assign(100, std::byte{7});
  keyframe.image = broken;
  EXPECT_GT(maker.builder->add(keyframe), 100U);
  EXPECT_EQ(maker.builder->bad_pictures(), 1U);
  EXPECT_FALSE(maker.builder->has_work());
  EXPECT_FALSE(maker.builder->step().has_value());
}

TEST(MapBuilder, StepsMakeTheMapLikeThePicture) {
  Maker maker;
  map::Keyframe keyframe = test::wall_keyframe(1, 4000);
  ASSERT_TRUE(keyframe.camera.has_value());
  const auto& model = keyframe.camera->model;
  auto red = std::make_shared<map::EncodedImage>();
  sensor::ImageRgb8 picture(model.width_px, model.height_px);
  for (std::size_t i = 0; i < picture.values.size(); i += 3) picture.values[i] = 200;
  red->bytes = *io::encode_jpeg(picture, 95);
  keyframe.image = red;
  maker.builder->add(keyframe);
  ASSERT_TRUE(maker.builder->has_work());
  const double first = maker.builder->step()->l1;
  for (int i = 0; i < 60; ++i) (void)maker.builder->step();
  EXPECT_LT(maker.builder->step()->l1, 0.9 * first);
  EXPECT_FALSE(maker.builder->take_changes().changed_rows.empty());
}

TEST(MapBuilder, GoesOnWithAMapMadeBefore) {
  Maker first;
  const auto wall = test::wall_keyframe(4, 3000);
  const std::size_t seeded = first.builder->add(wall);
  ASSERT_GT(seeded, 500U);
  Maker second;
  const auto& before = first.builder->engine().cloud();
  const auto restored =
      second.builder->restore(before, {first.builder->poses().begin(), first.builder->poses().end()});
  ASSERT_TRUE(restored.has_value());
  EXPECT_EQ(*restored, seeded);
  EXPECT_EQ(second.builder->engine().cloud().ids, before.ids);
  EXPECT_EQ(second.builder->take_changes().changed_rows.size(), seeded);
  EXPECT_LT(second.builder->add(wall), seeded / 20);  // the same wall is there
  auto another = test::wall_keyframe(5, 3000);
  another.odom_from_body.translation_m.y() = 50.0;
  EXPECT_GT(second.builder->add(another), seeded / 2);
  ASSERT_EQ(second.builder->poses().size(), 3U);
  EXPECT_EQ(second.builder->poses()[0].keyframe.value, 4U);
}

TEST(MapBuilder, RefusesAMapOfAnotherKind) {
  Maker maker;
  auto cloud = test::random_gaussians(10, 1, 3);
  mapping::EngineOptions options;
  options.optimiser.sh_degree = 0;
  maker.builder = *MapBuilder::create(options, maker.ids, maker.clock);
  EXPECT_FALSE(maker.builder->restore(cloud, {}).has_value());
  cloud = test::random_gaussians(10, 1, 0);
  cloud.means_m.pop_back();
  EXPECT_FALSE(maker.builder->restore(cloud, {}).has_value());
  EXPECT_EQ(maker.builder->engine().cloud().size(), 0U);
}

}  // namespace
}  // namespace edgesplat::optimise
