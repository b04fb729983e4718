// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/convert.hpp"
#include "common/io/gaussian_file.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

namespace edgesplat::desk {
namespace {

using ::testing::HasSubstr;

TEST(Convert, KeepsTheSidecarsWord) {
  const test::TempDir folder;
  io::MapSidecar sidecar;
  sidecar.frame = "map";
  sidecar.units = "m";
  sidecar.epoch = 4;
  const auto saved = save_map(folder / "a.ply", io::make_cloud(50, 2), sidecar);
  ASSERT_TRUE(saved) << saved.error().context;
  EXPECT_EQ(saved->stored_as, "x y z");
  const auto report = convert_map({folder / "a.ply", folder / "b.spz"});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_EQ(report->gaussians, 50U);
  EXPECT_EQ(report->sh_degree_out, 2);
  EXPECT_LT(report->position_error_max, 0.51 / 4096);
  const auto read = io::read_sidecar(folder / "b.spz").value();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->frame, "map");
  EXPECT_EQ(read->epoch, 4U);
  EXPECT_EQ(read->stored_as, "x -y -z");
}

TEST(Convert, TellsOfLostBands) {
  const test::TempDir folder;
  ASSERT_TRUE(io::write_gaussians(folder / "a.ply", io::make_cloud(5, 3)));
  const auto report = convert_map({folder / "a.ply", folder / "b.splat"});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_EQ(report->sh_degree_in, 3);
  EXPECT_EQ(report->sh_degree_out, 0);
  EXPECT_EQ(report->bytes_out, 5U * 32U);
  EXPECT_EQ(report->sidecar.frame, "unknown");
}

TEST(Convert, SaysWhatIsWrong) {
  const test::TempDir folder;
  ASSERT_TRUE(io::write_gaussians(folder / "a.ply", io::make_cloud(5, 0)));
  EXPECT_EQ(convert_map({folder / "a.ply", folder / "b.obj"}).error().code, Errc::kInvalidConfig);
  EXPECT_EQ(convert_map({folder / "none.ply", folder / "b.spz"}).error().code, Errc::kNotFound);
  folder.write("bad.spz", std::string_view("NGSP but no more"));
  EXPECT_THAT(convert_map({folder / "bad.spz", folder / "b.ply"}).error().context,
              HasSubstr("bad.spz: SPZ:"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.ply"));
}

}  // namespace
}  // namespace edgesplat::desk
