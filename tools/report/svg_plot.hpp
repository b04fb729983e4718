// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace edgesplat::report {

/// One curve. A value that is not finite breaks the line.
struct Series {
  enum class Style { kLine, kDots };
  std::string name;  ///< for the legend
  std::string colour;
  std::vector<double> x;
  std::vector<double> y;  ///< as long as x
  Style style = Style::kLine;
  double width_px = 1.6;
};

/// A picture under the curves, its edges in the plot's units.
struct Backdrop {
  std::string data_uri;
  double x_min = 0.0;
  double x_max = 0.0;
  double y_min = 0.0;
  double y_max = 0.0;
};

/// A coloured stretch of the x axis, as high as the plot, under the curves. Those with a name get a place in
/// the legend, each name once.
struct Band {
  std::string name;
  std::string colour;
  double x_min = 0.0;
  double x_max = 0.0;
};

struct Plot {
  std::string title;
  std::string x_label;  ///< with the unit
  std::string y_label;
  std::vector<Series> series;
  std::optional<Backdrop> backdrop = std::nullopt;
  std::vector<Band> bands = {};
  bool equal_scales =
      false;  ///< one metre is as long on both axes; `height` is then the most that may be used
  bool include_zero = false;  ///< the y axis starts at or passes through 0
  int width = 520;
  int height = 300;
};

/// Colours that stay apart for colour-blind readers (Okabe and Ito) and on light and dark pages.
inline constexpr const char* kBlue = "#0080c8";
inline constexpr const char* kOrange = "#e08a00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kRed = "#d55e00";
inline constexpr const char* kPurple = "#cc79a7";

/// The plot as an <svg> element that scales with the page. Axes and text use the page's colours (class names
/// of html_page.hpp). Curves of more than 1500 points are thinned, keeping the extremes.
[[nodiscard]] std::string draw(const Plot& plot);

}  // namespace edgesplat::report
