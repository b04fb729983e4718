// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_front.hpp"

#include "common/geometry/so3.hpp"
#include "test/robot/tracking/painted_room.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;
using test::PaintedRoom;

class VisualFrontInARoom : public testing::Test {
 protected:
  VisualFrontInARoom() { PaintedRoom::map(planes_); }

  sync::GroupImage picture(const RigidTransform& body, double gain = 1.0) const {
    sync::GroupImage image{};
    image.image = PaintedRoom::picture(camera_.model, body * camera_.body_from_camera, gain);
    return image;
  }
  static FilterBelief belief_at(const RigidTransform& body, double rot_sigma = 1e-4,
                                double pos_sigma = 1e-4) {
    FilterBelief belief;
    belief.state.odom_from_body = body;
    belief.covariance = 1e-8 * ErrorMatrix::Identity();
    belief.covariance.block<3, 3>(kRot, kRot).diagonal().setConstant(rot_sigma * rot_sigma);
    belief.covariance.block<3, 3>(kPos, kPos).diagonal().setConstant(pos_sigma * pos_sigma);
    belief.covariance(kGain, kGain) = 0.0;
    return belief;
  }
  /// Sees the room once from where the pose is known.
  void begin(VisualFront& front, const RigidTransform& body) {
    ASSERT_TRUE(front.take(picture(body)));
    EXPECT_FALSE(front.update(belief_at(body), PaintedRoom::scan(body, 3000)).updated);
    front.extend(belief_at(body), planes_);
    ASSERT_GT(front.map().size(), 60U);
  }
  /// What a second picture makes of a prior that is off by 3 cm and half a degree.
  VisualUpdateResult second(VisualFront& front, const RigidTransform& body, double gain = 1.0) {
    const RigidTransform off{body.rotation * geometry::so3_exp({0.005, -0.006, 0.004}),
                             body.translation_m + Vector3d(0.02, -0.015, 0.015)};
    EXPECT_TRUE(front.take(picture(body, gain)));
    return front.update(belief_at(off, 0.02, 0.05), PaintedRoom::scan(body, 3000));
  }

  const sensor::CameraMount camera_ = PaintedRoom::camera();
  const RigidTransform first_{geometry::so3_exp({0.0, 0.02, 0.1}), {-2.0, 0.3, 0.1}};
  const RigidTransform next_{geometry::so3_exp({0.01, 0.03, 0.16}), {-1.6, 0.4, 0.15}};
  PlaneMap planes_{PlaneMapConfig{}};
  const PointNoise noise_{sensor::LidarModel{}};
  BlockLoop loop_{1};
};

TEST_F(VisualFrontInARoom, FindsThePoseOfASecondPicture) {
  VisualFront front({}, camera_, noise_, loop_);
  begin(front, first_);
  const VisualUpdateResult result = second(front, next_);
  ASSERT_TRUE(result.updated);
  const RigidTransform& found = result.belief.state.odom_from_body;
  EXPECT_LT((found.translation_m - next_.translation_m).norm(), 0.003);
  EXPECT_LT(found.rotation.angularDistance(next_.rotation), 0.001);
  EXPECT_GT(result.patches, 50);
  EXPECT_NEAR(result.belief.state.log_gain, 0.0, 0.02);
  // What it claims is what it reached, within a few sigma.
  const double sigma_m = std::sqrt(result.belief.covariance.block<3, 3>(kPos, kPos).trace());
  EXPECT_LT(sigma_m, 0.01);
  EXPECT_LT((found.translation_m - next_.translation_m).norm(), 4.0 * sigma_m);
}

TEST_F(VisualFrontInARoom, AnExposureStepGoesIntoTheGain) {
  for (const double gain : {0.5, 1.25}) {
    VisualFront front({}, camera_, noise_, loop_);
    begin(front, first_);
    const VisualUpdateResult result = second(front, next_, gain);
    ASSERT_TRUE(result.updated) << gain;
    EXPECT_NEAR(result.belief.state.log_gain, std::log(gain), 0.03);
    EXPECT_LT((result.belief.state.odom_from_body.translation_m - next_.translation_m).norm(), 0.004) << gain;
  }
}

TEST_F(VisualFrontInARoom, APictureOfNothingOrAnotherSizeIsNotTaken) {
  VisualFront front({}, camera_, noise_, loop_);
  begin(front, first_);
  sync::GroupImage image{};
  image.image = std::make_shared<sensor::ImageRgb8>(320, 256);  // black
  EXPECT_FALSE(front.take(image));
  image.image = std::make_shared<sensor::ImageRgb8>(320, 256, std::uint8_t{255});
  EXPECT_FALSE(front.take(image));
  image.image = std::make_shared<sensor::ImageRgb8>(256, 320);
  EXPECT_FALSE(front.take(image));
  EXPECT_TRUE(second(front, next_).updated);  // and the map is as it was
}

TEST_F(VisualFrontInARoom, WhatTheScanSeesInFrontIsLeftOut) {
  VisualFront front({}, camera_, noise_, loop_);
  begin(front, first_);
  ASSERT_TRUE(front.take(picture(next_)));
  std::vector<Eigen::Vector3f> crowd;  // all around, at one metre
  test::Random random(5);
  for (int i = 0; i < 20000; ++i) crowd.push_back(random.direction().cast<float>());
  const VisualUpdateResult result = front.update(belief_at(next_), crowd);
  EXPECT_FALSE(result.updated);
  EXPECT_EQ(result.patches, 0);
}

TEST_F(VisualFrontInARoom, OneAndTwoThreadsGiveTheSameBits) {
  BlockLoop two(2);
  VisualFront with_one({}, camera_, noise_, loop_), with_two({}, camera_, noise_, two);
  begin(with_one, first_);
  begin(with_two, first_);
  const VisualUpdateResult a = second(with_one, next_), b = second(with_two, next_);
  EXPECT_EQ(a.belief.state.odom_from_body.matrix(), b.belief.state.odom_from_body.matrix());
  EXPECT_EQ(a.belief.covariance, b.belief.covariance);
}

TEST_F(VisualFrontInARoom, TheMapStaysBelowItsSize) {
  TrackingConfig config;
  config.visual_map_max_mb = 1;
  VisualFront front(config, camera_, noise_, loop_);
  RigidTransform body = first_;
  for (int i = 0; i < 40; ++i) {
    body.rotation = geometry::so3_exp({0, 0, 0.3 * i});
    ASSERT_TRUE(front.take(picture(body)));
    (void)front.update(belief_at(body), PaintedRoom::scan(body, 3000));
    front.extend(belief_at(body), planes_);
    ASSERT_LE(front.map().bytes(), std::size_t{1} << 20U);
  }
  EXPECT_GT(front.map().size(), 300U);
}

}  // namespace
}  // namespace edgesplat::tracking
