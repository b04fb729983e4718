// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_update.hpp"

#include "common/geometry/so3.hpp"
#include "test/robot/tracking/gaussian_room.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;
using test::PaintedRoom;

double other_painting(const Vector3d& p) {
  return 110.0 + 25.0 * (std::sin(3.7 * p.x() - 5.0 * p.z() + 1.0) + std::sin(6.1 * p.y() + 2.9 * p.z()) +
                         std::sin(8.3 * p.x() + 4.7 * p.y()));
}

class GaussianUpdateInARoom : public testing::Test {
 protected:
  static void SetUpTestSuite() { room_ = new test::CloudView(test::gaussian_room(PaintedRoom::brightness)); }
  static void TearDownTestSuite() {
    delete room_;
    room_ = nullptr;
  }
  static FilterBelief belief_at(const RigidTransform& body, double rot_sigma = 0.02,
                                double pos_sigma = 0.05) {
    FilterBelief belief;
    belief.state.odom_from_body = body;
    belief.covariance = 1e-4 * ErrorMatrix::Identity();
    belief.covariance.block<3, 3>(kRot, kRot).diagonal().setConstant(rot_sigma * rot_sigma);
    belief.covariance.block<3, 3>(kPos, kPos).diagonal().setConstant(pos_sigma * pos_sigma);
    return belief;
  }
  static RigidTransform disturbed(const RigidTransform& body, const Vector3d& turn_rad,
                                  const Vector3d& step_m) {
    return {body.rotation * geometry::so3_exp(turn_rad), body.translation_m + step_m};
  }
  sensor::ImageRgb8 photo(double gain = 1.0) const {
    return test::photograph(room_->cloud(), camera_.model, truth_ * camera_.body_from_camera, gain);
  }
  static bool untouched(const FilterBelief& before, const FilterBelief& after) {
    return before.state.odom_from_body.matrix() == after.state.odom_from_body.matrix() &&
           before.covariance == after.covariance &&
           before.state.velocity_in_odom_mps == after.state.velocity_in_odom_mps;
  }
  GaussianUpdateResult run(const FilterBelief& prior, const sensor::ImageRgb8& picture, GaussianView& map,
                           bool alone = true) {
    GaussianUpdater updater({}, camera_, loop_);
    return updater.run(prior, picture, PaintedRoom::scan(truth_, 20000), map, alone);
  }

  static test::CloudView* room_;
  const sensor::CameraMount camera_ = PaintedRoom::camera();
  const RigidTransform truth_{geometry::so3_exp({0.01, 0.03, 0.16}), {-1.6, 0.4, 0.15}};
  const RigidTransform off_ = disturbed(truth_, {0.008, -0.012, 0.009}, {0.012, -0.011, 0.011});
  BlockLoop loop_{1};
};
test::CloudView* GaussianUpdateInARoom::room_ = nullptr;

// 2 cm and 1 degree, in several directions. The photo is of the room, the map of Gaussians.
TEST_F(GaussianUpdateInARoom, RecoversADisturbedPose) {
  constexpr double kDegree = 0.017453;
  const Vector3d directions[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 1, 1}, {1, -1, 1}};
  for (const Vector3d& turn : directions) {
    const RigidTransform start = disturbed(truth_, kDegree * turn.normalized(),
                                           0.02 * Vector3d(turn.y(), turn.z(), turn.x()).normalized());
    const GaussianUpdateResult result = run(belief_at(start), photo(), *room_);
    ASSERT_TRUE(result.updated()) << static_cast<int>(result.verdict) << " at " << turn.transpose();
    const RigidTransform& found = result.belief.state.odom_from_body;
    EXPECT_LT((found.translation_m - truth_.translation_m).norm(), 0.002) << turn.transpose();
    EXPECT_LT(found.rotation.angularDistance(truth_.rotation), 0.05 * kDegree) << turn.transpose();
    EXPECT_GT(result.explained, 0.9);
    EXPECT_GT(result.coverage, 0.9);
    const double sigma_m = std::sqrt(result.belief.covariance.block<3, 3>(kPos, kPos).trace());
    EXPECT_LT((found.translation_m - truth_.translation_m).norm(), 4.0 * sigma_m);
    EXPECT_LT(sigma_m, 0.02);
  }
}

TEST_F(GaussianUpdateInARoom, BrightnessOfThePictureDoesNotMoveIt) {
  for (const double gain : {0.6, 1.2}) {
    const GaussianUpdateResult result = run(belief_at(off_), photo(gain), *room_);
    ASSERT_TRUE(result.updated()) << gain;
    const RigidTransform& found = result.belief.state.odom_from_body;
    EXPECT_LT((found.translation_m - truth_.translation_m).norm(), 0.002) << gain;
    EXPECT_LT(found.rotation.angularDistance(truth_.rotation), 0.001) << gain;
  }
}

// Something stands in a third of the picture, which the scan measures at 1 m.
TEST_F(GaussianUpdateInARoom, WhatTheScanSaysIsInFrontDoesNotCount) {
  sensor::ImageRgb8 picture = photo();
  for (int y = 40; y < 240; ++y) {
    for (int x = 200; x < 300; ++x) {
      const auto stripes = static_cast<std::uint8_t>(40 + 15 * ((x + y) / 9 % 8));
      std::fill_n(picture.pixel(x, y), 3, stripes);
    }
  }
  std::vector<Eigen::Vector3f> scan;
  const RigidTransform camera_from_body = camera_.body_from_camera.inverse();
  for (const Eigen::Vector3f& p : PaintedRoom::scan(truth_, 20000)) {
    const auto pixel = camera_.model.project(camera_from_body * p.cast<double>());
    const bool hidden = pixel && pixel->x() > 199 && pixel->x() < 300 && pixel->y() > 39 && pixel->y() < 240;
    const Vector3d in_camera = camera_from_body * p.cast<double>();
    scan.push_back(hidden ? (camera_.body_from_camera * Vector3d(in_camera / in_camera.z())).cast<float>()
                          : p);
  }
  GaussianUpdater updater({}, camera_, loop_);
  const GaussianUpdateResult result = updater.run(belief_at(off_), picture, scan, *room_, true);
  ASSERT_TRUE(result.updated()) << static_cast<int>(result.verdict);
  const RigidTransform& found = result.belief.state.odom_from_body;
  EXPECT_LT((found.translation_m - truth_.translation_m).norm(), 0.002);
  EXPECT_LT(found.rotation.angularDistance(truth_.rotation), 0.001);
  const GaussianUpdateResult without = run(belief_at(off_), photo(), *room_);
  EXPECT_LT(result.pixels, without.pixels);
  EXPECT_GT(result.explained, 0.85);
}

TEST_F(GaussianUpdateInARoom, RefusesWhatIsNoHelp) {
  const FilterBelief prior = belief_at(off_);
  const sensor::ImageRgb8 here = photo();
  class NoView : public GaussianView {
    std::optional<GaussianPicture> draw(const geometry::CameraModel&, const RigidTransform&) override {
      return std::nullopt;
    }
  } no_map;
  test::CloudView empty({});
  test::CloudView other(test::gaussian_room(other_painting));
  test::CloudView even(test::gaussian_room([](const Vector3d&) { return 120.0; }));
  sensor::ImageRgb8 black(camera_.model.width_px, camera_.model.height_px);
  sensor::ImageRgb8 small(64, 48, 90);
  test::Random random(3);
  sensor::ImageRgb8 noise(camera_.model.width_px, camera_.model.height_px);
  for (auto& value : noise.values) value = static_cast<std::uint8_t>(random.uniform(0.0, 255.0));
  const struct {
    const char* what;
    const sensor::ImageRgb8& picture;
    GaussianView& map;
    GaussianVerdict verdict;
  } cases[] = {
      {"no map", here, no_map, GaussianVerdict::kNoMap},
      {"empty map", here, empty, GaussianVerdict::kNoMap},
      {"a map of one colour", here, even, GaussianVerdict::kNoMap},
      {"black picture", black, *room_, GaussianVerdict::kNoPicture},
      {"picture of another size", small, *room_, GaussianVerdict::kNoPicture},
      {"map of another place", here, other, GaussianVerdict::kUnlike},
      {"noise", noise, *room_, GaussianVerdict::kUnlike},
  };
  for (const auto& one : cases) {
    const GaussianUpdateResult result = run(prior, one.picture, one.map);
    EXPECT_EQ(static_cast<int>(result.verdict), static_cast<int>(one.verdict))
        << one.what << ": explained " << result.explained;
    EXPECT_TRUE(untouched(prior, result.belief)) << one.what;
  }
}

// Alike, but 6 cm from where the filter is sure to be: a map that moved under it, say.
TEST_F(GaussianUpdateInARoom, APoseThatTheFilterHoldsToBeImpossibleIsRefused) {
  const FilterBelief sure = belief_at(disturbed(truth_, Vector3d::Zero(), {0.0, 0.06, 0.0}), 1e-4, 5e-4);
  const GaussianUpdateResult result = run(sure, photo(), *room_);
  EXPECT_EQ(static_cast<int>(result.verdict), static_cast<int>(GaussianVerdict::kContradicts))
      << result.chi_squared;
  EXPECT_TRUE(untouched(sure, result.belief));
}

TEST_F(GaussianUpdateInARoom, TheSameForEveryNumberOfThreads) {
  const FilterBelief prior = belief_at(off_);
  const auto picture = photo();
  const auto scan = PaintedRoom::scan(truth_, 5000);
  BlockLoop four(4);
  GaussianUpdater one_thread({}, camera_, loop_), four_threads({}, camera_, four);
  const auto a = one_thread.run(prior, picture, scan, *room_, false);
  const auto b = four_threads.run(prior, picture, scan, *room_, false);
  ASSERT_TRUE(a.updated());
  EXPECT_TRUE(untouched(a.belief, b.belief));
}

TEST_F(GaussianUpdateInARoom, TheScansDepthAddsToIt) {
  GaussianUpdateConfig and_depth;
  and_depth.depth = true;
  GaussianUpdater with(and_depth, camera_, loop_), without({}, camera_, loop_);
  const auto scan = PaintedRoom::scan(truth_, 20000);
  const auto a = with.run(belief_at(off_), photo(), scan, *room_, false);
  const auto b = without.run(belief_at(off_), photo(), scan, *room_, false);
  ASSERT_TRUE(a.updated() && b.updated());
  const auto spread = [](const GaussianUpdateResult& of) {
    return of.belief.covariance.block<3, 3>(kPos, kPos).trace();
  };
  EXPECT_LT(spread(a), spread(b));
  // The expected depth of a wall that is seen at a grazing angle is up to 5 cm too near, hence not closer.
  EXPECT_LT((a.belief.state.odom_from_body.translation_m - truth_.translation_m).norm(), 0.01);
}

}  // namespace
}  // namespace edgesplat::tracking
