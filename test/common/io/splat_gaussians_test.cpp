// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/splat_gaussians.hpp"
#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <array>
#include <limits>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;

std::vector<std::byte> make_record(std::array<float, 6> position_scale, std::array<int, 8> rgba_wxyz) {
  ByteWriter writer;
  for (const float value : position_scale) writer.write(value);
  for (const int value : rgba_wxyz) writer.write(static_cast<std::uint8_t>(value));
  return writer.take();
}

TEST(SplatFile, ReadsTheDocumentedRecord) {
  const auto cloud =
      parse_gaussians_splat(make_record({1, -2, 3, 1.0F, 0.5F, 0.0F}, {255, 0, 51, 204, 128, 255, 128, 128}));
  ASSERT_TRUE(cloud) << cloud.error().context;
  ASSERT_EQ(cloud->size(), 1U);
  EXPECT_THAT(cloud->means_m, ElementsAre(1.0F, -2.0F, 3.0F));
  EXPECT_THAT(cloud->log_scales, ElementsAre(0.0F, FloatNear(std::log(0.5F), 1e-6F), -20.0F));
  EXPECT_NEAR(0.5F + gaussian::GaussianCloud::kShC0 * cloud->sh[0], 1.0F, 1e-6F);
  EXPECT_NEAR(0.5F + gaussian::GaussianCloud::kShC0 * cloud->sh[2], 0.2F, 1e-6F);
  EXPECT_NEAR(cloud->opacity_logits[0], std::log(4.0F), 1e-5F);
  EXPECT_THAT(cloud->quats_xyzw, ElementsAre(1.0F, 0.0F, 0.0F, 0.0F));  // the file has w first
}

TEST(SplatFile, ReadsWhatItWrote) {
  const test::TempDir folder;
  const auto cloud = make_cloud(300, 2);
  ASSERT_TRUE(write_gaussians_splat(folder / "a.splat", cloud));
  EXPECT_EQ(std::filesystem::file_size(folder / "a.splat"), 300U * 32U);
  const auto read = read_gaussians_splat(folder / "a.splat");
  ASSERT_TRUE(read) << read.error().context;
  EXPECT_EQ(read->sh_degree, 0);
  EXPECT_EQ(read->means_m, cloud.means_m);
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    ASSERT_LT(angle_between_rad(*read, cloud, row), 0.03F);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(read->log_scales[3 * row + i], cloud.log_scales[3 * row + i], 1e-5F);
      const float colour = 0.5F + gaussian::GaussianCloud::kShC0 * cloud.sh[27 * row + i];
      const float read_colour = 0.5F + gaussian::GaussianCloud::kShC0 * read->sh[3 * row + i];
      ASSERT_NEAR(read_colour, std::clamp(colour, 0.0F, 1.0F), 0.51F / 255.0F);
    }
  }
}

TEST(SplatFile, SaysWhatIsWrong) {
  const auto refusal = [](const std::vector<std::byte>& bytes) {
    return parse_gaussians_splat(bytes).error().context;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(parse_gaussians_splat({})->size(), 0U);
  EXPECT_THAT(refusal(std::vector<std::byte>(33)), HasSubstr("no multiple of 32"));
  EXPECT_THAT(refusal(std::vector<std::byte>(32, std::byte{128})), HasSubstr("has a negative scale"));
  EXPECT_THAT(refusal(make_record({0, nan, 0, 1, 1, 1}, {0, 0, 0, 0, 255, 128, 128, 128})),
              HasSubstr("not finite"));
  EXPECT_THAT(refusal(make_record({0, 0, 0, 1, 1, 1}, {0, 0, 0, 0, 128, 128, 128, 128})),
              HasSubstr("Gaussian 0 has no rotation"));
}

}  // namespace
}  // namespace edgesplat::io
