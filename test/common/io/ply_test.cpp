// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/ply_points.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace edgesplat::io {
namespace {

using gaussian::GaussianCloud;
using ::testing::HasSubstr;

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

class GaussiansPly : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, GaussiansPly, ::testing::Values(0, 1, 2, 3));

TEST_P(GaussiansPly, ReadsWhatItWrote) {
  const test::TempDir folder;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3000}}) {
    const auto cloud = make_cloud(count, GetParam());
    ASSERT_TRUE(write_gaussians_ply(folder / "g.ply", cloud));
    const auto read = read_gaussians_ply(folder / "g.ply");
    ASSERT_TRUE(read) << read.error().context;
    EXPECT_TRUE(read->consistent());
    EXPECT_EQ(read->sh_degree, GetParam());
    EXPECT_EQ(read->means_m, cloud.means_m);
    EXPECT_EQ(read->log_scales, cloud.log_scales);
    EXPECT_EQ(read->opacity_logits, cloud.opacity_logits);
    EXPECT_EQ(read->sh, cloud.sh);
    ASSERT_EQ(read->quats_xyzw.size(), cloud.quats_xyzw.size());
    for (std::size_t i = 0; i < cloud.quats_xyzw.size(); ++i) {
      EXPECT_NEAR(read->quats_xyzw[i], cloud.quats_xyzw[i], 1e-6F);
    }
  }
}

TEST(GaussiansPlyLayout, IsInrias) {
  const test::TempDir folder;
  auto cloud = make_cloud(1, 1);
  for (std::size_t i = 0; i < 12; ++i) cloud.sh[i] = static_cast<float>(i);
  ASSERT_TRUE(write_gaussians_ply(folder / "g.ply", cloud));
  const auto text = read_text_file(folder / "g.ply", 10'000).value();
  const auto body = text.find("end_header\n") + 11;
  ASSERT_EQ(text.size() - body, (3 + 3 + 3 + 9 + 1 + 3 + 4) * sizeof(float));
  std::array<float, 26> row{};
  std::memcpy(row.data(), text.data() + body, sizeof(row));
  // f_rest runs channel by channel: red of the bases 1..3, then green, then blue.
  EXPECT_THAT(std::span(row).subspan(9, 9), ::testing::ElementsAre(3, 6, 9, 4, 7, 10, 5, 8, 11));
  EXPECT_EQ(row[22], cloud.quats_xyzw[3]);  // w first
}

constexpr std::string_view kAsciiGaussians =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 1\n"
    "property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\n"
    "property double scale_2\nproperty float scale_1\nproperty float scale_0\nproperty uchar extra\n"
    "property float opacity\nproperty float f_dc_2\nproperty float f_dc_1\nproperty float f_dc_0\n"
    "property float z\nproperty float y\nproperty float x\nend_header\n"
    "2 0 0 0  -3 -2 -1 9  0.5  0.3 0.2 0.1  30 20 10\n";

TEST(GaussiansPlyLayout, AcceptsAnyOrderAndAscii) {
  const auto cloud = parse_gaussians_ply(as_bytes(kAsciiGaussians));
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_EQ(cloud->sh_degree, 0);
  EXPECT_THAT(cloud->means_m, ::testing::ElementsAre(10, 20, 30));
  EXPECT_THAT(cloud->log_scales, ::testing::ElementsAre(-1, -2, -3));
  EXPECT_THAT(cloud->quats_xyzw, ::testing::ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(cloud->sh, ::testing::ElementsAre(0.1F, 0.2F, 0.3F));
}

TEST(GaussiansPlyLayout, SaysWhatIsWrong) {
  const auto context = [](std::string text, std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
    const auto cloud = parse_gaussians_ply(as_bytes(text));
    return cloud ? std::string("accepted") : cloud.error().context;
  };
  const std::string good(kAsciiGaussians);
  EXPECT_THAT(context(good, "float opacity", "float opaque"), HasSubstr("no column opacity"));
  EXPECT_THAT(context(good, "uchar extra", "float f_rest_0"), HasSubstr("1 f_rest columns"));
  EXPECT_THAT(context(good, "2 0 0 0 ", "0 0 0 0 "), HasSubstr("Gaussian 0 has no rotation"));
  EXPECT_THAT(context(good, " 0.5 ", " nan "), HasSubstr("Gaussian 0 is not finite"));
  EXPECT_THAT(context(good, " 0.5 ", " half "), HasSubstr("vertex 0 is not made of numbers"));
  EXPECT_THAT(context(good, "vertex 1", "vertex 99999999999999999"), HasSubstr("truncated"));
  EXPECT_THAT(context(good, "vertex 1", "vertex -1"), HasSubstr("not a number"));
  EXPECT_THAT(context(good, "end_header", "end_heading"), HasSubstr("unknown line"));
  EXPECT_THAT(context(good, "uchar extra", "list uchar int extra"), HasSubstr("lists"));
  EXPECT_THAT(context(good, "ply\n", "plx\n"), HasSubstr("not a PLY file"));
}

TEST(GaussiansPlyLayout, AcceptsBigEndian) {
  const test::TempDir folder;
  const auto cloud = make_cloud(5, 1);
  ASSERT_TRUE(write_gaussians_ply(folder / "g.ply", cloud));
  auto bytes = read_file(folder / "g.ply", 1U << 20U).value();
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto body = text.find("end_header\n") + 11;
  for (std::size_t i = body; i + 4 <= bytes.size(); i += 4) std::reverse(&bytes[i], &bytes[i] + 4);
  std::string big = text.substr(0, body);
  big.replace(big.find("little"), 6, "big");
  std::vector<std::byte> turned(reinterpret_cast<const std::byte*>(big.data()),
                                reinterpret_cast<const std::byte*>(big.data()) + big.size());
  turned.insert(turned.end(), bytes.begin() + static_cast<std::ptrdiff_t>(body), bytes.end());
  const auto read = parse_gaussians_ply(turned);
  ASSERT_TRUE(read) << read.error().context;
  EXPECT_EQ(read->means_m, cloud.means_m);
  EXPECT_EQ(read->sh, cloud.sh);
}

TEST(GaussiansPlyLayout, RefusesWhatNoReaderWouldTake) {
  const test::TempDir folder;
  auto cloud = make_cloud(2, 0);
  cloud.opacity_logits[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(write_gaussians_ply(folder / "g.ply", cloud).error().context, HasSubstr("Gaussian 1 is not"));
  cloud = make_cloud(2, 0);
  cloud.sh.pop_back();
  EXPECT_EQ(write_gaussians_ply(folder / "g.ply", cloud).error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "g.ply"));
}

PointCloud make_points(std::size_t count) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<float>(i);
    cloud.points_m.emplace_back(value, -value, 0.5F * value);
    cloud.rgb.push_back({static_cast<std::uint8_t>(i), 128, 255});
  }
  return cloud;
}

TEST(PointsPly, ReadsWhatItWrote) {
  const test::TempDir folder;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{50'000}}) {
    auto cloud = make_points(count);
    ASSERT_TRUE(write_points_ply(folder / "p.ply", cloud));
    const auto coloured = read_points_ply(folder / "p.ply");
    ASSERT_TRUE(coloured);
    EXPECT_EQ(coloured->points_m, cloud.points_m);
    EXPECT_EQ(coloured->rgb, cloud.rgb);
    cloud.rgb.clear();
    ASSERT_TRUE(write_points_ply(folder / "p.ply", cloud));
    EXPECT_TRUE(read_points_ply(folder / "p.ply").value().rgb.empty());
  }
  PointCloud uneven = make_points(3);
  uneven.rgb.pop_back();
  EXPECT_FALSE(write_points_ply(folder / "p.ply", uneven));
}

TEST(PointsPly, ReadsAsciiWithFacesAndFloatColours) {
  const auto cloud = parse_points_ply(
      as_bytes("ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty double x\r\nproperty double "
               "y\r\nproperty double z\r\n"
               "property float red\r\nproperty float green\r\nproperty float blue\r\nelement face 1\r\n"
               "property list uchar int vertex_indices\r\nend_header\r\n1 2 3 0 0.5 1\r\n4 5 6 2 -1 nan\r\n3 "
               "0 1 1\r\n"));
  ASSERT_TRUE(cloud) << cloud.error().context;
  ASSERT_EQ(cloud->points_m.size(), 2U);
  EXPECT_EQ(cloud->points_m[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_THAT(cloud->rgb[0], ::testing::ElementsAre(0, 128, 255));
  EXPECT_THAT(cloud->rgb[1], ::testing::ElementsAre(255, 0, 0));
}

TEST(PlyHostile, TruncationAndDamageAreSurvived) {
  const test::TempDir folder;
  ASSERT_TRUE(write_points_ply(folder / "p.ply", make_points(20)));
  ASSERT_TRUE(write_gaussians_ply(folder / "g.ply", make_cloud(20, 1)));
  std::mt19937 random(6);
  for (const char* name : {"p.ply", "g.ply"}) {
    const auto whole = read_file(folder / name, 1U << 20U).value();
    for (std::size_t length = 0; length < whole.size(); ++length) {
      ASSERT_FALSE(parse_points_ply(std::span(whole).first(length))) << length;
      ASSERT_FALSE(parse_gaussians_ply(std::span(whole).first(length))) << length;
    }
    for (int round = 0; round < 3000; ++round) {
      auto damaged = whole;
      for (int i = 0; i < 3; ++i) damaged[random() % 300] = static_cast<std::byte>(random());
      (void)parse_points_ply(damaged);
      (void)parse_gaussians_ply(damaged);
    }
  }
}

}  // namespace
}  // namespace edgesplat::io
