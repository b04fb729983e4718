// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/held_out_views.hpp"

#include <gtest/gtest.h>

#include <set>

namespace edgesplat::quality {
namespace {

HostTime at(double seconds) {
  return HostTime{} + from_seconds(seconds);
}

geometry::RigidTransform pose(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& t_m) {
  geometry::RigidTransform out;
  out.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
  out.translation_m = t_m;
  return out;
}

/// A straight drive at 10 Hz with a keyframe every fourth pose, in a map that lies askew in the world.
struct Drive {
  geometry::RigidTransform map_from_world = pose(0.4, {0.2, -0.5, 1.0}, {3.0, -2.0, 1.0});
  geometry::RigidTransform body_from_camera = pose(1.2, {1.0, -1.0, 1.0}, {0.1, 0.0, 0.2});
  std::vector<accuracy::PosePair> truth;
  std::vector<SavedKeyframe> keyframes;

  Drive() {
    for (int i = 0; i < 41; ++i) {
      accuracy::PosePair pair;
      pair.stamp = at(0.1 * i);
      pair.reference = pose(0.01 * i, {0, 0, 1}, {0.12 * i, 0.0, 0.0});
      truth.push_back(pair);
      if (i % 4 != 0) continue;
      SavedKeyframe keyframe;
      keyframe.stamp = pair.stamp;
      keyframe.map_from_camera = map_from_world * pair.reference * body_from_camera;
      keyframes.push_back(keyframe);
    }
  }
};

TEST(AlignMap, FindsHowTheMapLiesEvenOnAStraightDrive) {
  const Drive drive;
  const auto found = align_map(drive.keyframes, drive.truth, drive.body_from_camera);
  ASSERT_TRUE(found) << found.error().context;
  EXPECT_LT((found->translation_m - drive.map_from_world.translation_m).norm(), 1e-9);
  EXPECT_LT(found->rotation.angularDistance(drive.map_from_world.rotation), 1e-7);
}

TEST(AlignMap, SaysWhenNothingFits) {
  Drive drive;
  for (SavedKeyframe& keyframe : drive.keyframes) keyframe.stamp += from_seconds(0.05);
  EXPECT_FALSE(align_map(drive.keyframes, drive.truth, drive.body_from_camera));
}

TEST(HeldOutViews, LieBetweenKeyframesWhereTheTruthSays) {
  const Drive drive;
  const auto views = choose_held_out_views(drive.keyframes, drive.truth, drive.body_from_camera, 100);
  ASSERT_TRUE(views) << views.error().context;
  ASSERT_EQ(views->size(), 10U);
  for (std::size_t i = 0; i < views->size(); ++i) {
    const HeldOutView& view = (*views)[i];
    const std::size_t row = 4 * i + 2;  // the middle of keyframes 4 i and 4 i + 4
    EXPECT_EQ(view.stamp, drive.truth[row].stamp);
    const auto expected = drive.map_from_world * drive.truth[row].reference * drive.body_from_camera;
    EXPECT_LT((view.map_from_camera.translation_m - expected.translation_m).norm(), 1e-9);
    EXPECT_TRUE(view.nearest_keyframe == i || view.nearest_keyframe == i + 1);
  }
}

TEST(HeldOutViews, AreSpreadEvenlyWhenThereAreTooMany) {
  const Drive drive;
  const auto views = choose_held_out_views(drive.keyframes, drive.truth, drive.body_from_camera, 3);
  ASSERT_TRUE(views) << views.error().context;
  std::set<std::int64_t> stamps;
  for (const HeldOutView& view : *views) stamps.insert(to_ns(view.stamp));
  EXPECT_EQ(stamps.size(), 3U);
  EXPECT_LT(*stamps.begin(), to_ns(at(1.2)));
  EXPECT_GT(*stamps.rbegin(), to_ns(at(2.8)));
}

TEST(MostAlike, WeighsTurnsAndWays) {
  const Drive drive;
  EXPECT_EQ(most_alike(drive.keyframes, drive.keyframes[6].map_from_camera), 6U);
  std::vector<SavedKeyframe> two(2);
  two[0].map_from_camera = pose(0.0, {0, 0, 1}, {0.5, 0.0, 0.0});
  two[1].map_from_camera = pose(0.2, {0, 0, 1}, {0.0, 0.0, 0.0});  // about as far as 0.6 m
  EXPECT_EQ(most_alike(two, {}), 0U);
  two[1].map_from_camera = pose(0.1, {0, 0, 1}, {0.0, 0.0, 0.0});
  EXPECT_EQ(most_alike(two, {}), 1U);
}

/// Pictures of moments between the drive's keyframes, in two blocks.
std::vector<SavedKeyframe> pictures_between(const Drive& drive) {
  std::vector<SavedKeyframe> pictures;
  for (const std::size_t row : {5U, 6U, 7U, 33U, 34U, 35U}) {
    SavedKeyframe picture;
    picture.stamp = drive.truth[row].stamp;
    picture.map_from_camera = drive.map_from_world * drive.truth[row].reference * drive.body_from_camera;
    picture.image = std::to_string(row) + ".jpg";
    picture.block = row < 20 ? 0 : 1;
    pictures.push_back(picture);
  }
  return pictures;
}

TEST(ViewsOfPictures, AreThePicturesWithTheKeyframeMostAlike) {
  const Drive drive;
  const auto pictures = pictures_between(drive);
  const auto views = views_of_pictures(drive.keyframes, pictures, 24);
  ASSERT_TRUE(views) << views.error().context;
  ASSERT_EQ(views->size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((*views)[i].stamp, pictures[i].stamp);
    EXPECT_EQ((*views)[i].picture, pictures[i].image);
    EXPECT_EQ((*views)[i].block, pictures[i].block);
    EXPECT_EQ((*views)[i].map_from_camera.translation_m, pictures[i].map_from_camera.translation_m);
  }
  EXPECT_EQ((*views)[0].nearest_keyframe, 1U);
  EXPECT_EQ((*views)[2].nearest_keyframe, 2U);
  EXPECT_EQ((*views)[5].nearest_keyframe, 9U);
}

TEST(ViewsOfPictures, AreSpreadEvenlyWhenThereAreTooMany) {
  const Drive drive;
  const auto views = views_of_pictures(drive.keyframes, pictures_between(drive), 2);
  ASSERT_TRUE(views);
  ASSERT_EQ(views->size(), 2U);
  EXPECT_EQ((*views)[0].picture, "6.jpg");
  EXPECT_EQ((*views)[1].picture, "34.jpg");
}

TEST(ViewsOfPictures, APictureThatWasMappedIsRefused) {
  const Drive drive;
  auto pictures = pictures_between(drive);
  pictures[4].stamp = drive.keyframes[8].stamp;
  const auto views = views_of_pictures(drive.keyframes, pictures, 24);
  ASSERT_FALSE(views);
  EXPECT_EQ(views.error().code, Errc::kCorrupt);
  EXPECT_NE(views.error().context.find("34.jpg was not held out"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::quality
