// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/patch_picture.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::report {
namespace {

constexpr const char* kHeader = "x_px,y_px,side_px,misfit,used\n";

CsvTable table_of(const std::string& rows) {
  return *CsvTable::parse(kHeader + rows, "patches.csv");
}
std::string figure_of(const std::string& rows) {
  const auto figure = patch_picture(sensor::ImageRgb8(320, 256, 90), table_of(rows), "keyframe 7");
  EXPECT_TRUE(figure.has_value());
  return figure.value_or("");
}
/// How often a text occurs.
int count(const std::string& in, const std::string& text) {
  int times = 0;
  for (std::size_t at = in.find(text); at != std::string::npos; at = in.find(text, at + 1)) ++times;
  return times;
}

TEST(PatchPicture, DrawsEachPatchWhereItIs) {
  // A figure is 640 units wide, the picture 320 pixels: the middle of pixel 40 is at 81, a patch of 8 pixels
  // is 16 wide.
  const std::string figure = figure_of("40,30,8,0,1\n");
  EXPECT_NE(figure.find("M73.0 53.0h16.0v16.0h-16.0z"), std::string::npos) << figure;
  EXPECT_NE(figure.find("<title>misfit 0.0</title>"), std::string::npos);
  EXPECT_NE(figure.find("keyframe 7: 1 of 1 patches used"), std::string::npos);
}

TEST(PatchPicture, WhatWasLeftOutIsCrossedOutAndOnTop) {
  const std::string figure = figure_of("40,30,8,14.5,0\n90,30,8,0.5,1\n");
  EXPECT_NE(figure.find("keyframe 7: 1 of 2 patches used"), std::string::npos);
  const std::size_t out = figure.find("misfit 14.5, not used"), in = figure.find("misfit 0.5<");
  ASSERT_NE(out, std::string::npos);
  ASSERT_NE(in, std::string::npos);
  EXPECT_LT(in, out);
}

TEST(PatchPicture, ColoursGoWithTheMisfit) {
  const std::string good = figure_of("40,30,8,0,1\n"), bad = figure_of("40,30,8,3,1\n"),
                    worse = figure_of("40,30,8,9,1\n");
  // The best fit has the first colour of the scale, everything from 3 on the last.
  const auto colour = [](const std::string& figure) {
    const std::string mark = "stroke-width=\"3.6\"/><path d=";
    const std::size_t at = figure.find("stroke=\"#", figure.find(mark) + mark.size());
    return figure.substr(at + 8, 7);
  };
  EXPECT_EQ(colour(good), "#40e0d0");
  EXPECT_EQ(colour(bad), "#ff8c28");
  EXPECT_EQ(colour(worse), colour(bad));
}

TEST(PatchPicture, PlacesOutOfThePictureAndRubbishAreLeftOut) {
  const std::string figure = figure_of(
      "-50,30,8,1,1\n40,900,8,1,1\nnan,30,8,1,1\n40,30,8,inf,1\n40,30,x,1,1\n1e300,1e300,1e300,1,1\n10,10,8,"
      "1,1\n");
  EXPECT_NE(figure.find("keyframe 7: 1 of 1 patches used"), std::string::npos);
  EXPECT_EQ(count(figure, "nan"), 0);
  EXPECT_EQ(count(figure, "inf"), 0);
}

TEST(PatchPicture, TooManyAreCut) {
  std::string rows;
  for (int i = 0; i < 20000; ++i) rows += "40,30,8,1,1\n";
  EXPECT_NE(figure_of(rows).find("5000 of 5000 patches used"), std::string::npos);
}

TEST(PatchPicture, ATableOfSomethingElseIsRefused) {
  const auto refused =
      patch_picture(sensor::ImageRgb8(32, 24, 90), *CsvTable::parse("a,b\n1,2\n", "x.csv"), "keyframe 7");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::kCorrupt);
  EXPECT_NE(refused.error().context.find("x_px"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::report
