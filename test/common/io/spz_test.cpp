// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/byte_compression.hpp"
#include "common/io/spz_gaussians.hpp"
#include "kernels/splat/sh_math.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

float opacity(float logit) {
  return 1.0F / (1.0F + std::exp(-logit));
}

struct Shape {
  std::uint32_t version;
  int sh_degree;
};
class SpzRoundTrip : public ::testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, SpzRoundTrip,
                         ::testing::Values(Shape{2, 0}, Shape{2, 3}, Shape{3, 1}, Shape{3, 3}, Shape{4, 0},
                                           Shape{4, 1}, Shape{4, 2}, Shape{4, 3}));

TEST_P(SpzRoundTrip, KeepsEverythingToHalfAStep) {
  const test::TempDir folder;
  auto cloud = make_cloud(500, GetParam().sh_degree);
  for (float& value : cloud.sh) value = std::clamp(value * 0.3F, -0.95F, 0.9F);  // SH is kept over -1..1
  ASSERT_TRUE(write_gaussians_spz(folder / "a.spz", cloud, GetParam().version));
  const auto read = read_gaussians_spz(folder / "a.spz");
  ASSERT_TRUE(read) << read.error().context;
  ASSERT_TRUE(read->consistent());
  ASSERT_EQ(read->size(), cloud.size());
  ASSERT_EQ(read->sh_degree, cloud.sh_degree);
  const std::size_t sh_each = cloud.sh_floats_each();
  const float angle_limit_rad = GetParam().version == 2 ? 0.25F : 0.006F;  // w from x, y, z
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    for (std::size_t i = 3 * row; i < 3 * row + 3; ++i) {
      ASSERT_NEAR(read->means_m[i], cloud.means_m[i], 0.51F / 4096.0F);
      ASSERT_NEAR(read->log_scales[i], cloud.log_scales[i], 0.51F / 16.0F);
    }
    ASSERT_NEAR(opacity(read->opacity_logits[row]), opacity(cloud.opacity_logits[row]), 0.51F / 255.0F);
    ASSERT_LT(angle_between_rad(*read, cloud, row), angle_limit_rad);
    for (std::size_t i = 0; i < sh_each; ++i) {
      const float step = i < 3 ? 1.0F / 38.25F : i < 12 ? 1.0F / 16.0F : 1.0F / 8.0F;
      ASSERT_NEAR(read->sh[row * sh_each + i], cloud.sh[row * sh_each + i], 0.57F * step) << i;
    }
  }
}

TEST(Spz, EmptyAndFarCloudsComeBack) {
  const test::TempDir folder;
  ASSERT_TRUE(write_gaussians_spz(folder / "none.spz", make_cloud(0, 2)));
  EXPECT_EQ(read_gaussians_spz(folder / "none.spz").value().size(), 0U);
  auto cloud = make_cloud(1, 0);
  cloud.means_m = {100'000.0F, -30.0F, 0.0F};  // 12 fractional bits reach 2 km only
  ASSERT_TRUE(write_gaussians_spz(folder / "far.spz", cloud));
  EXPECT_THAT(read_gaussians_spz(folder / "far.spz").value().means_m, ElementsAre(100'000.0F, -30.0F, 0.0F));
  cloud.means_m[0] = 9e6F;
  EXPECT_EQ(write_gaussians_spz(folder / "out.spz", cloud).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(write_gaussians_spz(folder / "v1.spz", make_cloud(1, 0), 1).error().code, Errc::kInvalidArgument);
}

// The bytes below are made from the published description of the format, not by the writer under test.

void write_legacy_header(ByteWriter& writer, std::uint32_t version, std::uint8_t degree) {
  writer.write_text("NGSP");
  writer.write(version);
  writer.write(std::uint32_t{1});
  writer.write(degree);
  for (const int byte : {8, 0, 0})
    writer.write(static_cast<std::uint8_t>(byte));  // fractional bits, flags, reserved
}

/// Opacity 128, colour 255 0 128, scales 160 176 144.
void write_alpha_colour_scale(ByteWriter& writer) {
  for (const int byte : {128, 255, 0, 128, 160, 176, 144}) writer.write(static_cast<std::uint8_t>(byte));
}

void expect_alpha_colour_scale(const gaussian::GaussianCloud& cloud) {
  EXPECT_NEAR(opacity(cloud.opacity_logits[0]), 128.0F / 255.0F, 1e-6F);
  EXPECT_NEAR(cloud.sh[0], 0.5F / 0.15F, 1e-5F);
  EXPECT_NEAR(cloud.sh[1], -0.5F / 0.15F, 1e-5F);
  EXPECT_NEAR(cloud.sh[2], (128.0F / 255.0F - 0.5F) / 0.15F, 1e-5F);
  EXPECT_THAT(cloud.log_scales, ElementsAre(0.0F, 1.0F, -1.0F));
}

TEST(SpzBytes, VersionOneHasHalfFloats) {
  ByteWriter writer;
  write_legacy_header(writer, 1, 0);
  for (const int half : {0x3C00, 0x4000, 0xC200}) writer.write(static_cast<std::uint16_t>(half));  // 1, 2, -3
  write_alpha_colour_scale(writer);
  for (const int byte : {255, 127, 128}) writer.write(static_cast<std::uint8_t>(byte));
  const auto cloud = parse_gaussians_spz(gzip(writer.bytes()).value());
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_THAT(cloud->means_m, ElementsAre(1.0F, -2.0F, 3.0F));
  EXPECT_NEAR(cloud->quats_xyzw[0], 1.0F, 1e-4F);
  expect_alpha_colour_scale(*cloud);
}

TEST(SpzBytes, VersionTwoHasFixedPoint) {
  ByteWriter writer;
  write_legacy_header(writer, 2, 0);
  for (const int byte : {0x80, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0xFF, 0xFF}) {  // 1.5, 2, -1 at 8 bits
    writer.write(static_cast<std::uint8_t>(byte));
  }
  write_alpha_colour_scale(writer);
  for (const int byte : {128, 128, 128}) writer.write(static_cast<std::uint8_t>(byte));
  const auto cloud = parse_gaussians_spz(gzip(writer.bytes()).value());
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_THAT(cloud->means_m, ElementsAre(1.5F, -2.0F, 1.0F));
  EXPECT_NEAR(cloud->quats_xyzw[3], 1.0F, 1e-4F);
  expect_alpha_colour_scale(*cloud);
}

/// A version 4 file of one Gaussian with these nine degree-1 SH bytes; `extension` lies before the table.
std::vector<std::byte> make_version_4(std::span<const std::uint8_t> sh, std::string_view extension = "") {
  ByteWriter rest;
  write_alpha_colour_scale(rest);
  const auto plain = rest.bytes();
  const std::uint32_t word = 3U << 30U | 0x3FFU << 20U;  // w largest, x = -sqrt(1/2), y = z = 0
  const std::array<std::uint8_t, 9> position = {0x00, 0x10, 0x00, 0x00, 0xF0, 0xFF, 0x01, 0x00, 0x00};
  std::vector<std::span<const std::byte>> streams = {
      std::as_bytes(std::span(position)), plain.first(1),   plain.subspan(1, 3), plain.subspan(4, 3),
      std::as_bytes(std::span(&word, 1)), std::as_bytes(sh)};
  ByteWriter file;
  file.write_text("NGSP");
  file.write(std::uint32_t{4});
  file.write(std::uint32_t{1});
  const std::array<std::uint8_t, 4> fields = {1, 12, static_cast<std::uint8_t>(extension.empty() ? 0 : 2), 6};
  for (const std::uint8_t byte : fields) file.write(byte);
  file.write(static_cast<std::uint32_t>(32 + extension.size()));
  for (int i = 0; i < 12; ++i) file.write(std::uint8_t{0});
  file.write_text(extension);
  std::vector<std::vector<std::byte>> compressed;
  for (const auto stream : streams) {
    compressed.push_back(zstd_compress(stream, 1).value());
    file.write(std::uint64_t{compressed.back().size()});
    file.write(std::uint64_t{stream.size()});
  }
  for (const auto& bytes : compressed) file.write_bytes(bytes);
  return file.take();
}

constexpr std::array<std::uint8_t, 9> kShBytes = {192, 128, 128, 160, 128, 128, 64, 128, 128};

TEST(SpzBytes, VersionFourIsAHeaderAndSixStreams) {
  for (const std::string_view extension : {"", "\x02\x00\xBE\xAD\x04\x00\x00\x00....", "half a record"}) {
    const auto cloud = parse_gaussians_spz(make_version_4(kShBytes, extension));
    ASSERT_TRUE(cloud) << cloud.error().context;
    EXPECT_THAT(cloud->means_m, ElementsAre(1.0F, 1.0F, -1.0F / 4096.0F));
    EXPECT_NEAR(cloud->quats_xyzw[0], -std::numbers::sqrt2_v<float> / 2, 1e-3F);
    EXPECT_NEAR(cloud->quats_xyzw[3], std::numbers::sqrt2_v<float> / 2, 1e-3F);
    expect_alpha_colour_scale(*cloud);
  }
}

TEST(SpzBytes, TurningTheAxesTurnsTheColours) {
  for (std::size_t basis = 1; basis < 16; ++basis) {
    ByteWriter writer;
    write_legacy_header(writer, 2, 3);
    for (int i = 0; i < 9; ++i) writer.write(std::uint8_t{0});
    write_alpha_colour_scale(writer);
    for (int i = 0; i < 3; ++i) writer.write(std::uint8_t{128});
    for (std::size_t i = 0; i < 45; ++i)
      writer.write(static_cast<std::uint8_t>(i / 3 == basis - 1 ? 192 : 128));
    const auto cloud = parse_gaussians_spz(gzip(writer.bytes()).value());
    ASSERT_TRUE(cloud) << cloud.error().context;
    std::array<float, 16> in_file{}, read{};
    splat::sh_basis(3, 0.36F, 0.48F, 0.8F, in_file.data());
    splat::sh_basis(3, 0.36F, -0.48F, -0.8F, read.data());  // the same direction in the cloud's axes
    float colour = 0.0F;
    for (std::size_t k = 1; k < 16; ++k) colour += read[k] * cloud->sh[3 * k];
    EXPECT_NEAR(colour, 0.5F * in_file[basis], 1e-6F) << basis;
  }
}

TEST(SpzWriter, WritesTheDocumentedHeader) {
  const test::TempDir folder;
  ASSERT_TRUE(write_gaussians_spz(folder / "a.spz", make_cloud(3, 1)));
  const auto bytes = read_file(folder / "a.spz", 1U << 20U).value();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint32_t>(), 0x5053474EU);
  EXPECT_EQ(reader.read<std::uint32_t>(), 4U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 3U);
  for (const int byte : {1, 12, 0, 6}) EXPECT_EQ(reader.read<std::uint8_t>(), byte);
  EXPECT_EQ(reader.read<std::uint32_t>(), 32U);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(reader.read<std::uint8_t>(), 0);
  std::uint64_t compressed = 0;
  for (const std::uint64_t plain : {27U, 3U, 9U, 9U, 12U, 27U}) {
    compressed += reader.read<std::uint64_t>();
    EXPECT_EQ(reader.read<std::uint64_t>(), plain);
  }
  EXPECT_EQ(reader.remaining(), compressed);
}

}  // namespace
}  // namespace edgesplat::io
