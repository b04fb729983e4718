// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace edgesplat::io {
namespace {

using gaussian::GaussianCloud;

/// npm's @playcanvas/splat-transform, as tools/setup --peers installs it (or EDGESPLAT_PEERS_NODE, a
/// node_modules).
std::filesystem::path peer_program() {
  const char* chosen = std::getenv("EDGESPLAT_PEERS_NODE");
  const std::filesystem::path modules =
      chosen != nullptr ? chosen : EDGESPLAT_SOURCE_DIR "/.deps/peers-node/node_modules";
  return modules / "@playcanvas" / "splat-transform" / "bin" / "cli.mjs";
}

/// Values that every format holds: colours within 0..1, SH within -1..1, scales of millimetres to metres;
/// every x its own, so that rows are known again after sorting.
GaussianCloud make_tame_cloud(int sh_degree) {
  GaussianCloud cloud = make_cloud(700, sh_degree);
  for (std::size_t i = 0; i < 700; ++i)
    cloud.means_m[3 * i] = 0.01F * static_cast<float>((i * 37) % 700) - 3.5F;
  for (float& value : cloud.log_scales) value = std::clamp(value - 3.0F, -6.0F, 0.0F);
  for (float& value : cloud.opacity_logits) value = std::clamp(value, -3.0F, 3.0F);
  for (float& value : cloud.sh) value = std::clamp(0.3F * value, -0.8F, 0.8F);
  return cloud;
}

/// Rows by their x: writers sort.
std::vector<std::size_t> rows_by_x(const GaussianCloud& cloud) {
  std::vector<std::size_t> rows(cloud.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::sort(rows, {}, [&cloud](std::size_t row) { return cloud.means_m[3 * row]; });
  return rows;
}

struct Tolerance {
  float mean, log_scale, opacity, colour, sh, angle_rad;
};

float opacity(float logit) {
  return 1.0F / (1.0F + std::exp(-logit));
}

float angle_rad(const float* a, const float* b) {
  const float dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  return 2.0F * std::acos(std::min(1.0F, std::abs(dot)));
}

void expect_same(const GaussianCloud& read, const GaussianCloud& truth, const Tolerance& within) {
  ASSERT_EQ(read.size(), truth.size());
  ASSERT_EQ(read.sh_degree, truth.sh_degree);
  const auto rows = rows_by_x(read), true_rows = rows_by_x(truth);
  const std::size_t sh_each = truth.sh_floats_each();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t a = rows[i], b = true_rows[i];
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(read.means_m[3 * a + k], truth.means_m[3 * b + k], within.mean) << i;
      ASSERT_NEAR(read.log_scales[3 * a + k], truth.log_scales[3 * b + k], within.log_scale) << i;
    }
    ASSERT_NEAR(opacity(read.opacity_logits[a]), opacity(truth.opacity_logits[b]), within.opacity) << i;
    ASSERT_LT(angle_rad(&read.quats_xyzw[4 * a], &truth.quats_xyzw[4 * b]), within.angle_rad) << i;
    for (std::size_t k = 0; k < sh_each; ++k) {
      ASSERT_NEAR(read.sh[sh_each * a + k], truth.sh[sh_each * b + k], k < 3 ? within.colour : within.sh)
          << i;
    }
  }
}

class SplatTransformPeer : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(peer_program())) {
      GTEST_SKIP() << "no " << peer_program() << ": run tools/setup --peers";
    }
  }
  void transform(const std::string& in, const std::string& out) {
    const std::string command = "node '" + peer_program().string() + "' -w '" + (folder_ / in).string() +
                                "' '" + (folder_ / out).string() + "' >'" + (folder_ / "log").string() +
                                "' 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }
  test::TempDir folder_;
};

constexpr Tolerance kSpz = {0.6F / 4096, 0.6F / 16, 0.6F / 255, 0.6F / 38, 0.6F / 8, 0.008F};

TEST_F(SplatTransformPeer, ItReadsOurPly) {
  const auto cloud = make_tame_cloud(3);
  ASSERT_TRUE(write_gaussians(folder_ / "a.ply", cloud));
  transform("a.ply", "b.ply");
  expect_same(read_gaussians(folder_ / "b.ply").value(), cloud, {1e-6F, 1e-6F, 1e-6F, 1e-6F, 1e-6F, 1e-3F});
}

TEST_F(SplatTransformPeer, ItReadsOurSpz) {
  for (const std::uint32_t version : {2U, 3U, 4U}) {
    for (const int degree : {0, 3}) {
      const auto cloud = make_tame_cloud(degree);
      ASSERT_TRUE(write_gaussians(folder_ / "a.spz", cloud, version));
      transform("a.spz", "b.ply");
      Tolerance within = kSpz;
      if (version == 2) within.angle_rad = 0.25F;
      expect_same(read_gaussians(folder_ / "b.ply").value(), cloud, within);
    }
  }
}

TEST_F(SplatTransformPeer, ItReadsOurSplat) {
  const auto cloud = make_tame_cloud(0);
  ASSERT_TRUE(write_gaussians(folder_ / "a.splat", cloud));
  transform("a.splat", "b.ply");
  expect_same(read_gaussians(folder_ / "b.ply").value(), cloud,
              {1e-6F, 1e-5F, 0.6F / 255, 0.6F / 255 / GaussianCloud::kShC0, 1.0F, 0.03F});
}

TEST_F(SplatTransformPeer, WeReadItsSpz) {
  const auto cloud = make_tame_cloud(2);
  ASSERT_TRUE(write_gaussians(folder_ / "a.ply", cloud));
  transform("a.ply", "b.spz");
  expect_same(read_gaussians(folder_ / "b.spz").value(), cloud, kSpz);
}

TEST_F(SplatTransformPeer, WeReadItsCompressedPly) {
  const auto cloud = make_tame_cloud(1);
  ASSERT_TRUE(write_gaussians(folder_ / "a.ply", cloud));
  transform("a.ply", "b.compressed.ply");
  // Positions have 10 or 11 bits over a chunk of 256, here some metres; colours 8 bits over its range.
  const auto read = read_gaussians(folder_ / "b.compressed.ply").value();
  transform("b.compressed.ply", "c.ply");
  const auto theirs = read_gaussians(folder_ / "c.ply").value();
  ASSERT_EQ(read.size(), cloud.size());
  expect_same(read, theirs, {1e-5F, 1e-5F, 1e-3F, 1e-5F, 1e-5F, 2e-3F});
}

}  // namespace
}  // namespace edgesplat::io
