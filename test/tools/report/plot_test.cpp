// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plot_scale.hpp"
#include "tools/report/svg_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::report {
namespace {

using testing::HasSubstr;
using testing::Not;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(RangeOf, CoversTheFiniteValuesWithAMargin) {
  const std::vector<double> values = {kNan, 10.0, 20.0, std::numeric_limits<double>::infinity()};
  const AxisRange range = range_of({&values}, false);
  EXPECT_NEAR(range.low, 9.6, 1e-9);
  EXPECT_NEAR(range.high, 20.4, 1e-9);
  EXPECT_EQ(range_of({&values}, true).low, 0.0);
}

TEST(RangeOf, HasAWidthForEqualAndForNoValues) {
  const std::vector<double> same = {5.0, 5.0};
  EXPECT_LT(range_of({&same}, false).low, 5.0);
  EXPECT_GT(range_of({&same}, false).high, 5.0);
  const std::vector<double> none = {kNan};
  EXPECT_GT(range_of({&none}, true).length(), 0.0);
  EXPECT_GT(range_of({}, false).length(), 0.0);
  const std::vector<double> zeros = {0.0};
  EXPECT_GT(range_of({&zeros}, true).length(), 0.0);
}

TEST(TicksOf, AreRoundAndInside) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks_of({-0.13, 0.52}, 5)) labels.push_back(tick.label);
  EXPECT_THAT(labels, testing::ElementsAre("0.0", "0.2", "0.4"));
  labels.clear();
  for (const Tick& tick : ticks_of({0.0, 1700.0}, 4)) labels.push_back(tick.label);
  EXPECT_THAT(labels, testing::ElementsAre("0", "500", "1000", "1500"));
  labels.clear();
  for (const Tick& tick : ticks_of({0.0, 26000.0}, 3)) labels.push_back(tick.label);
  EXPECT_THAT(labels, testing::ElementsAre("0", "10k", "20k"));
  EXPECT_TRUE(ticks_of({1.0, 1.0}, 5).empty());
}

TEST(Thin, KeepsEndsAndExtremes) {
  std::vector<double> y(100'000, 0.0);
  y[54'321] = 9.0;
  y[12'345] = -9.0;
  const auto kept = thin(y, 1000);
  EXPECT_LE(kept.size(), 1000U);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), y.size() - 1);
  EXPECT_THAT(kept, testing::Contains(54'321U));
  EXPECT_THAT(kept, testing::Contains(12'345U));
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(thin({1.0, 2.0}, 1000).size(), 2U);
}

TEST(Draw, NamesAxesWithUnitsAndEscapesText) {
  const Plot plot{"A & B", "time (s)", "error (cm)", {{"<x>", kBlue, {0, 1}, {1, 2}}}};
  const std::string svg = draw(plot);
  EXPECT_THAT(svg, HasSubstr("A &amp; B"));
  EXPECT_THAT(svg, HasSubstr("time (s)"));
  EXPECT_THAT(svg, HasSubstr("error (cm)"));
  EXPECT_THAT(svg, HasSubstr("&lt;x&gt;"));
}

TEST(Draw, BreaksTheLineAtValuesThatAreNotFinite) {
  const Plot plot{"t", "x", "y", {{"s", kBlue, {0, 1, 2, 3, 4}, {1, 2, kNan, 2, 1}}}};
  const std::string svg = draw(plot);
  const std::string path = svg.substr(svg.find("<path"));
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Draw, EqualScalesKeepASquareSquare) {
  Plot plot{"t", "x", "y", {{"s", kBlue, {0, 10}, {0, 10}, Series::Style::kDots}}};
  plot.equal_scales = true;
  const std::string svg = draw(plot);
  std::vector<std::pair<double, double>> centres;  // of the two dots; the legend's comes first
  for (std::size_t at = svg.find("<circle cx="); at != std::string::npos;
       at = svg.find("<circle cx=", at + 1)) {
    double x = 0.0;
    double y = 0.0;
    ASSERT_EQ(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\"", &x, &y), 2);
    centres.emplace_back(x, y);
  }
  ASSERT_EQ(centres.size(), 3U);
  EXPECT_NEAR(centres[2].first - centres[1].first, centres[1].second - centres[2].second, 0.2);
}

TEST(Draw, SurvivesAPlotWithoutData) {
  EXPECT_THAT(draw({"t", "x", "y", {}}), HasSubstr("</svg>"));
  EXPECT_THAT(draw({"t", "x", "y", {{"none", kRed, {}, {}}}}), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace edgesplat::report
