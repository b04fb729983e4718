// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cloud_picture.hpp"
#include "tools/report/csv_table.hpp"
#include "tools/report/html_text.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::report {
namespace {

std::string base64_of(std::string_view text) {
  return base64(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(Base64, OfTheRfcsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
}

TEST(EscapeHtml, LeavesNothingThatActs) {
  EXPECT_EQ(escape_html("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
}

TEST(CsvTable, ReadsColumnsByName) {
  const auto table = CsvTable::parse("a_ms,state,b_ms\n1.5,ok,2\n-,bad,3\n\n", "x.csv");
  ASSERT_TRUE(table) << table.error().context;
  EXPECT_EQ(table->rows(), 2U);
  EXPECT_EQ(table->numbers("a_ms")[0], 1.5);
  EXPECT_TRUE(std::isnan(table->numbers("a_ms")[1]));
  EXPECT_THAT(table->texts("state"), testing::ElementsAre("ok", "bad"));
  EXPECT_THAT(table->names_ending("_ms"), testing::ElementsAre("a_ms", "b_ms"));
  EXPECT_TRUE(table->numbers("none").empty());
}

TEST(CsvTable, RefusesRowsOfAnotherLength) {
  const auto table = CsvTable::parse("a,b\n1,2\n1,2,3\n", "x.csv");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, Errc::kCorrupt);
  EXPECT_THAT(table.error().context, testing::HasSubstr("x.csv:3"));
  EXPECT_EQ(CsvTable::parse("", "x.csv")->rows(), 0U);
}

TEST(Percentile, IsTheNearestRank) {
  EXPECT_FALSE(percentile({}, 0.5));
  EXPECT_EQ(percentile({3.0}, 0.95), 3.0);
  std::vector<double> hundred;
  for (int i = 100; i >= 1; --i) hundred.push_back(i);
  EXPECT_EQ(percentile(hundred, 0.50), 50.0);
  EXPECT_EQ(percentile(hundred, 0.95), 95.0);
  EXPECT_EQ(percentile(hundred, 1.0), 100.0);
  hundred.push_back(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(percentile(hundred, 1.0), 100.0);
}

TEST(CompareRender, OfKnownPictures) {
  const sensor::ImageRgb8 camera(8, 4, 100);
  EXPECT_EQ(compare_render(camera, camera)->psnr_db, 99.0);
  EXPECT_EQ(compare_render(camera, camera)->coverage, 1.0);
  EXPECT_NEAR(compare_render(camera, sensor::ImageRgb8(8, 4, 151))->psnr_db, 20.0 * std::log10(5.0), 1e-9);
  EXPECT_FALSE(compare_render(camera, sensor::ImageRgb8(4, 8, 100)));
  EXPECT_FALSE(compare_render({}, {}));
}

TEST(CompareRender, LeavesOutWhatIsNotMapped) {
  const sensor::ImageRgb8 camera(8, 4, 100);
  sensor::ImageRgb8 render(8, 4, 0);
  EXPECT_FALSE(compare_render(camera, render));
  for (int x = 0; x < 8; ++x) std::fill_n(render.pixel(x, 0), 3, std::uint8_t{151});
  EXPECT_NEAR(compare_render(camera, render)->psnr_db, 20.0 * std::log10(5.0), 1e-9);
  EXPECT_NEAR(compare_render(camera, render)->coverage, 0.25, 1e-12);
}

io::PointCloud two_points() {
  io::PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    cloud.points_m.emplace_back(0.0F, 0.0F, 0.0F);
    cloud.rgb.push_back({255, 0, 0});
    cloud.points_m.emplace_back(10.0F, 5.0F, 0.5F);
    cloud.rgb.push_back({0, 255, 0});
  }
  return cloud;
}

TEST(TopView, PutsPointsWhereTheyAre) {
  const TopView view = draw_top_view(two_points(), {100.0F}, 200);
  EXPECT_EQ(view.picture.width_px, 200);
  EXPECT_EQ(view.picture.height_px, 100);
  EXPECT_NEAR(view.x_max_m, 10.0, 0.1);
  EXPECT_NEAR(view.y_max_m, 5.0, 0.1);
  EXPECT_EQ(view.picture.pixel(0, 99)[0], 255);   // the origin, bottom left, is red
  EXPECT_EQ(view.picture.pixel(199, 0)[1], 255);  // the far corner, top right, is green
}

TEST(TopView, CutsWhatIsAboveAndLeavesOutliersOut) {
  io::PointCloud cloud = two_points();
  EXPECT_LT(draw_top_view(cloud, {0.2F}, 200).picture.pixel(199, 0)[1], 50);
  cloud.points_m.emplace_back(1e6F, 0.0F, 0.0F);
  cloud.rgb.push_back({0, 0, 255});
  EXPECT_NEAR(draw_top_view(cloud, {100.0F}, 200).x_max_m, 10.0, 0.1);
}

TEST(TopView, NothingForNoPointsAndHeightColoursForPlainOnes) {
  EXPECT_TRUE(draw_top_view({}, {0.0F}, 100).picture.empty());
  io::PointCloud plain = two_points();
  plain.rgb.clear();
  const TopView view = draw_top_view(plain, {100.0F}, 200);
  EXPECT_NE(view.picture.pixel(0, 99)[0], view.picture.pixel(199, 0)[0]);
}

TEST(ObliqueView, ShowsThePoints) {
  const auto picture = draw_oblique_view(two_points(), {100.0F}, 160, 100);
  int coloured = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 160; ++x) coloured += picture.pixel(x, y)[0] == 255 || picture.pixel(x, y)[1] == 255;
  }
  EXPECT_GE(coloured, 2);
  EXPECT_EQ(draw_oblique_view({}, {0.0F}, 16, 10).width_px, 16);
}

}  // namespace
}  // namespace edgesplat::report
