// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"
#include "kernels/splat/render.hpp"
#include "test/common/map/delta_samples.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace edgesplat::map {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 256;

std::vector<float> picture(const gaussian::GaussianCloud& cloud) {
  const geometry::CameraModel camera{geometry::CameraKind::kPinhole,
                                     kWidth_px,
                                     kHeight_px,
                                     256.0,
                                     256.0,
                                     0.5 * kWidth_px,
                                     0.5 * kHeight_px,
                                     {}};
  const auto view = splat::View::from(camera, {});
  EXPECT_TRUE(view.has_value());
  constexpr std::size_t kPixels = std::size_t{kWidth_px} * kHeight_px;
  std::vector<float> colour(3 * kPixels), depth(kPixels), alpha(kPixels);
  const auto stats =
      splat::render(core::Backend::kCpu, splat::spans_of(cloud), *view, {}, {colour, depth, alpha});
  EXPECT_TRUE(stats.has_value());
  EXPECT_GT(stats->visible, cloud.size() / 4);
  return colour;
}

double psnr_db(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference =
        std::clamp(static_cast<double>(a[i]), 0.0, 1.0) - std::clamp(static_cast<double>(b[i]), 0.0, 1.0);
    sum += difference * difference;
  }
  return -10.0 * std::log10(sum / static_cast<double>(a.size()));
}

/// A room full of small, stretched Gaussians of every colour: nothing for the eye to average over.
gaussian::GaussianCloud scene(int sh_degree) {
  test::Random random(1);
  test::CloudShape shape;
  shape.count = 20000;
  shape.sh_degree = sh_degree;
  shape.scale_min_m = 0.01;
  shape.scale_max_m = 0.15;
  return test::random_cloud(random, shape);
}

double loss_of_a_round_trip_db(int sh_degree) {
  const auto cloud = scene(sh_degree);
  const auto bytes = encode_delta({test::sample_header(), AddBody{test::quantised(cloud)}});
  EXPECT_TRUE(bytes.has_value());
  const auto back = decode_delta(*bytes);
  EXPECT_TRUE(back.has_value());
  const double psnr = psnr_db(picture(cloud), picture(dequantise(std::get<AddBody>(back->body).rows)));
  ::testing::Test::RecordProperty("psnr_db", std::to_string(psnr));
  ::testing::Test::RecordProperty("bytes_each", std::to_string(static_cast<double>(bytes->size()) / 20000.0));
  return psnr;
}

// The gate of the codec: below these figures the robot would see worse than the server.
TEST(CodecQuality, PicturesLoseNothingVisibleAtSh0) {
  EXPECT_GE(loss_of_a_round_trip_db(0), 45.0);
}
TEST(CodecQuality, PicturesLoseNothingVisibleAtSh3) {
  EXPECT_GE(loss_of_a_round_trip_db(3), 40.0);
}

}  // namespace
}  // namespace edgesplat::map
