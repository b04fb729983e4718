// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/map_sidecar.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

TEST(GaussianFile, TheEndingDecides) {
  const test::TempDir folder;
  const auto cloud = make_cloud(10, 1);
  for (const char* name : {"a.ply", "a.spz", "A.SPLAT"}) {
    ASSERT_TRUE(write_gaussians(folder / name, cloud)) << name;
    const auto read = read_gaussians(folder / name);
    ASSERT_TRUE(read) << read.error().context;
    EXPECT_EQ(read->size(), 10U);
  }
  EXPECT_THAT(read_gaussians(folder / "a.ksplat").error().context, HasSubstr(".ply, .spz or .splat"));
  EXPECT_EQ(read_gaussians(folder / "none.spz").error().code, Errc::kNotFound);
}

std::filesystem::path shared_splat(const char* name) {
  return std::filesystem::path(EDGESPLAT_SOURCE_DIR) / ".." / "shared" / "data" / "splats" / name;
}

TEST(GaussianFile, ReadsOneSceneFromTwoFormats) {
  const auto spz_file = shared_splat("biker.spz");
  const auto ply_file = shared_splat("biker.compressed.ply");
  if (!std::filesystem::exists(spz_file)) GTEST_SKIP() << spz_file << " is absent";
  const auto spz = read_gaussians(spz_file);
  const auto ply = read_gaussians(ply_file);
  ASSERT_TRUE(spz) << spz.error().context;
  ASSERT_TRUE(ply) << ply.error().context;
  ASSERT_EQ(spz->size(), 152'746U);
  ASSERT_EQ(ply->size(), spz->size());
  // The writers sort differently, so the scenes are compared by their centre and extent.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sums[2] = {0, 0};
    for (std::size_t row = 0; row < spz->size(); ++row) {
      sums[0] += spz->means_m[3 * row + axis];
      sums[1] += ply->means_m[3 * row + axis];
    }
    EXPECT_NEAR(sums[0] / 152'746, sums[1] / 152'746, 1e-3) << axis;
  }
}

TEST(MapSidecar, ReadsWhatItWrote) {
  const test::TempDir folder;
  const MapSidecar sidecar{"map", "m", "z up", "x -y -z", 2, "sRGB", 7, true, 1'000'000};
  ASSERT_TRUE(write_sidecar(folder / "a.spz", sidecar));
  EXPECT_TRUE(std::filesystem::exists(folder / "a.spz.json"));
  EXPECT_EQ(read_sidecar(folder / "a.spz").value(), sidecar);
  EXPECT_EQ(read_sidecar(folder / "b.spz").value(), std::nullopt);
}

TEST(MapSidecar, SaysWhatIsWrong) {
  const auto refusal = [](std::string_view text) {
    const auto sidecar = parse_sidecar(text);
    return sidecar ? "accepted" : sidecar.error().context;
  };
  EXPECT_THAT(refusal("{"), HasSubstr("not JSON"));
  EXPECT_THAT(refusal("[]"), HasSubstr("not a JSON object"));
  EXPECT_THAT(refusal("{}"), HasSubstr("kind"));
  EXPECT_THAT(refusal(R"({"kind":"edgesplat map","version":2})"), HasSubstr("version 2"));
  EXPECT_THAT(refusal(R"({"kind":"edgesplat map","version":1,"epoch":-1})"), HasSubstr("epoch"));
  EXPECT_THAT(refusal(R"({"kind":"edgesplat map","version":1,"frame":3})"), HasSubstr("frame"));
  EXPECT_THAT(refusal(R"({"kind":"edgesplat map","version":1,"sh_degree":4})"), HasSubstr("sh_degree"));
  EXPECT_THAT(refusal(R"({"kind":"edgesplat map","version":1,"sky_included":1})"), HasSubstr("sky"));
  EXPECT_EQ(refusal(R"({"kind":"edgesplat map","version":1})"), "accepted");
}

}  // namespace
}  // namespace edgesplat::io
