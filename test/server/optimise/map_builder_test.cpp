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

}  // namespace
}  // namespace edgesplat::optimise
