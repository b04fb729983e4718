// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/ply_gaussians.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <string>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string properties(const char* type, std::initializer_list<const char*> names) {
  std::string text;
  for (const char* name : names) text += std::string("property ") + type + " " + name + "\n";
  return text;
}

struct Sample {
  bool colour_ranges = true;
  std::uint32_t rows = 1;
  int sh_columns = 0;
  std::uint32_t position = 0x7FFU << 21U;  // x at its maximum, y and z at their minimum
  std::uint32_t rotation = 1U << 30U | 512U << 20U | 512U << 10U | 512U;
  std::uint32_t scale = 0;
  std::uint32_t colour = 0xFF0080FF;
};

/// One chunk: positions -1..3, -2..2, 5..6; log scales -4..-2 each; colours 0..2.
std::vector<std::byte> make_file(const Sample& sample) {
  ByteWriter writer;
  writer.write_text("ply\nformat binary_little_endian 1.0\nelement chunk 1\n");
  writer.write_text(
      properties("float", {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y",
                           "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"}));
  if (sample.colour_ranges) {
    writer.write_text(properties("float", {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"}));
  }
  writer.write_text("element vertex " + std::to_string(sample.rows) + "\n");
  writer.write_text(
      properties("uint", {"packed_position", "packed_rotation", "packed_scale", "packed_color"}));
  if (sample.sh_columns > 0) writer.write_text("element sh " + std::to_string(sample.rows) + "\n");
  for (int i = 0; i < sample.sh_columns; ++i) {
    writer.write_text("property uchar f_rest_" + std::to_string(i) + "\n");
  }
  writer.write_text("end_header\n");
  for (const int value : {-1, -2, 5, 3, 2, 6, -4, -4, -4, -2, -2, -2})
    writer.write(static_cast<float>(value));
  if (sample.colour_ranges) {
    for (const int value : {0, 0, 0, 2, 2, 2}) writer.write(static_cast<float>(value));
  }
  for (std::uint32_t i = 0; i < sample.rows; ++i) {
    for (const auto word : {sample.position, sample.rotation, sample.scale, sample.colour})
      writer.write(word);
  }
  for (std::uint32_t i = 0; i < sample.rows; ++i) {
    for (int k = 0; k < sample.sh_columns; ++k)
      writer.write(static_cast<std::uint8_t>(k == 0 ? 255 : 127 + k));
  }
  return writer.take();
}

TEST(CompressedPly, UnpacksEachField) {
  const auto cloud = parse_gaussians_ply(make_file({}));
  ASSERT_TRUE(cloud) << cloud.error().context;
  ASSERT_EQ(cloud->size(), 1U);
  EXPECT_EQ(cloud->sh_degree, 0);
  EXPECT_THAT(cloud->means_m, ElementsAre(3.0F, -2.0F, 5.0F));
  EXPECT_THAT(cloud->log_scales, ElementsAre(-4.0F, -4.0F, -4.0F));
  // Largest is the second of w, x, y, z: a half turn about x, but for the rounding of 512 / 1023.
  EXPECT_NEAR(cloud->quats_xyzw[0], 1.0F, 1e-5F);
  EXPECT_NEAR(cloud->quats_xyzw[3], 0.0F, 1e-3F);
  const auto rgb = [&](std::size_t i) { return 0.5F + gaussian::GaussianCloud::kShC0 * cloud->sh[i]; };
  EXPECT_NEAR(rgb(0), 2.0F, 1e-5F);
  EXPECT_NEAR(rgb(1), 0.0F, 1e-5F);
  EXPECT_NEAR(rgb(2), 2.0F * 128.0F / 255.0F, 1e-5F);
  EXPECT_NEAR(cloud->opacity_logits[0], std::log(0.999F / 0.001F), 1e-3F);
}

TEST(CompressedPly, OldFilesHaveColoursFromZeroToOne) {
  const auto cloud = parse_gaussians_ply(make_file({.colour_ranges = false}));
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_NEAR(0.5F + gaussian::GaussianCloud::kShC0 * cloud->sh[0], 1.0F, 1e-5F);
}

TEST(CompressedPly, UnpacksSphericalHarmonics) {
  const auto cloud = parse_gaussians_ply(make_file({.rows = 2, .sh_columns = 9}));
  ASSERT_TRUE(cloud) << cloud.error().context;
  ASSERT_EQ(cloud->sh_degree, 1);
  const float* second = &cloud->sh[12];
  EXPECT_FLOAT_EQ(second[3], 4.0F);                                   // red of basis 1: 255
  EXPECT_FLOAT_EQ(second[6], 8.0F * ((128.0F + 0.5F) / 256 - 0.5F));  // red of basis 2: 128
  EXPECT_FLOAT_EQ(second[4], 8.0F * ((130.0F + 0.5F) / 256 - 0.5F));  // green of basis 1: 130
}

TEST(CompressedPly, SaysWhatIsWrong) {
  const auto refused = [](const Sample& sample) {
    return parse_gaussians_ply(make_file(sample)).error().context;
  };
  EXPECT_THAT(refused({.rows = 257}), HasSubstr("too few chunks"));
  EXPECT_THAT(refused({.sh_columns = 8}), HasSubstr("8 f_rest columns"));
}

TEST(CompressedPly, TruncationAndDamageAreSurvived) {
  const auto whole = make_file({.rows = 9, .sh_columns = 9});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_FALSE(parse_gaussians_ply(std::span(whole).first(length))) << length;
  }
  std::mt19937 random(3);
  for (int round = 0; round < 5000; ++round) {
    auto damaged = whole;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    const auto cloud = parse_gaussians_ply(damaged);
    ASSERT_TRUE(!cloud || cloud->consistent());
  }
}

}  // namespace
}  // namespace edgesplat::io
