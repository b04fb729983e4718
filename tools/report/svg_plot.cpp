// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/svg_plot.hpp"

#include "tools/report/html_text.hpp"
#include "tools/report/plot_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::report {
namespace {

constexpr std::size_t kMaxPoints = 1500;
constexpr double kCharacterWidth = 6.9;  // of the page's 12 px font, on average
constexpr double kLegendLine = 17.0;
constexpr double kBelowFrame = 40.0;  // for the numbers and the name of the x axis
constexpr double kLowestFrame = 130.0;
constexpr double kBandOpacity = 0.25;

/// Where the curves go inside the picture, and from which data range.
struct Frame {
  double left = 58.0;
  double top = 28.0;
  double right = 0.0;
  double bottom = 0.0;
  AxisRange x;
  AxisRange y;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
  [[nodiscard]] double px(double value) const { return left + (value - x.low) / x.length() * width(); }
  [[nodiscard]] double py(double value) const { return bottom - (value - y.low) / y.length() * height(); }
};

AxisRange widened(const AxisRange& range, double length) {
  const double extra = 0.5 * (length - range.length());
  return {range.low - extra, range.high + extra};
}

/// The longer of the two scales rules both, so that shapes keep their proportions.
void equalise(Frame& frame) {
  const double units_per_px = std::max(frame.x.length() / frame.width(), frame.y.length() / frame.height());
  frame.x = widened(frame.x, units_per_px * frame.width());
  frame.y = widened(frame.y, units_per_px * frame.height());
}

/// What stands in the legend: the curves, then each name of a band.
struct LegendEntry {
  enum class Mark { kLine, kDot, kBand };
  std::string name;
  std::string colour;
  Mark mark;
};

std::vector<LegendEntry> legend_of(const Plot& plot) {
  std::vector<LegendEntry> entries;
  for (const Series& series : plot.series) {
    const bool line = series.style == Series::Style::kLine;
    entries.push_back(
        {series.name, series.colour, line ? LegendEntry::Mark::kLine : LegendEntry::Mark::kDot});
  }
  const auto first_band = static_cast<std::ptrdiff_t>(entries.size());
  for (const Band& band : plot.bands) {
    const bool known = std::any_of(entries.begin() + first_band, entries.end(),
                                   [&](const LegendEntry& entry) { return entry.name == band.name; });
    if (!band.name.empty() && !known) entries.push_back({band.name, band.colour, LegendEntry::Mark::kBand});
  }
  return entries;
}

std::string legend_mark(const LegendEntry& entry, double x, double y) {
  switch (entry.mark) {
    case LegendEntry::Mark::kLine:
      return fmt::format(
          R"(<line x1="{:.0f}" y1="{:.0f}" x2="{:.0f}" y2="{:.0f}" stroke="{}" stroke-width="3"/>)", x, y - 4,
          x + 14, y - 4, entry.colour);
    case LegendEntry::Mark::kDot:
      return fmt::format(R"(<circle cx="{:.0f}" cy="{:.0f}" r="3.5" fill="{}"/>)", x + 7, y - 4,
                         entry.colour);
    case LegendEntry::Mark::kBand:
      break;
  }
  return fmt::format(R"(<rect x="{:.0f}" y="{:.0f}" width="14" height="10" fill="{}" fill-opacity="{}"/>)", x,
                     y - 9, entry.colour, kBandOpacity);
}

/// Legend entries flow left to right below the title; returns its height.
double draw_legend(const std::vector<LegendEntry>& entries, int plot_width, std::string& svg) {
  double x = 58.0;
  double y = 34.0;
  for (const LegendEntry& entry : entries) {
    const double width = 34.0 + kCharacterWidth * static_cast<double>(entry.name.size());
    if (x > 58.0 && x + width > plot_width) {
      x = 58.0;
      y += kLegendLine;
    }
    svg += legend_mark(entry, x, y);
    svg += fmt::format(R"(<text x="{:.0f}" y="{:.0f}">{}</text>)", x + 19, y, escape_html(entry.name));
    x += width;
  }
  return y;
}

struct DataRanges {
  AxisRange x;
  AxisRange y;
};

DataRanges ranges_of(const Plot& plot) {
  std::vector<const std::vector<double>*> xs;
  std::vector<const std::vector<double>*> ys;
  for (const Series& series : plot.series) {
    xs.push_back(&series.x);
    ys.push_back(&series.y);
  }
  std::vector<double> backdrop_x;
  std::vector<double> backdrop_y;
  if (plot.backdrop) {
    backdrop_x = {plot.backdrop->x_min, plot.backdrop->x_max};
    backdrop_y = {plot.backdrop->y_min, plot.backdrop->y_max};
    xs.push_back(&backdrop_x);
    ys.push_back(&backdrop_y);
  }
  std::vector<double> band_x;
  for (const Band& band : plot.bands) band_x.insert(band_x.end(), {band.x_min, band.x_max});
  if (!band_x.empty()) xs.push_back(&band_x);
  return {range_of(xs, false), range_of(ys, plot.include_zero)};
}

Frame lay_out(const Plot& plot, double legend_bottom) {
  const DataRanges ranges = ranges_of(plot);
  Frame frame;
  frame.top = legend_bottom + 10.0;
  frame.right = plot.width - 12.0;
  frame.bottom = plot.height - kBelowFrame;
  frame.x = ranges.x;
  frame.y = ranges.y;
  if (plot.equal_scales) {
    // A long, low shape gets a low frame instead of empty space above and below.
    const double wanted = std::max(frame.width() * frame.y.length() / frame.x.length(), kLowestFrame);
    frame.bottom = std::min(frame.bottom, frame.top + wanted);
    equalise(frame);
  }
  return frame;
}

void draw_axes(const Plot& plot, const Frame& f, std::string& svg) {
  for (const Tick& tick : ticks_of(f.x, static_cast<int>(f.width() / 70.0))) {
    const double x = f.px(tick.value);
    svg += fmt::format(R"(<line class="grid" x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}"/>)", x,
                       f.top, f.bottom);
    svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", x, f.bottom + 15,
                       tick.label);
  }
  for (const Tick& tick : ticks_of(f.y, std::max(static_cast<int>(f.height() / 40.0), 3))) {
    const double y = f.py(tick.value);
    svg += fmt::format(R"(<line class="grid" x1="{1:.1f}" y1="{0:.1f}" x2="{2:.1f}" y2="{0:.1f}"/>)", y,
                       f.left, f.right);
    svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)", f.left - 5, y + 4,
                       tick.label);
  }
  svg += fmt::format(R"(<rect class="axis" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", f.left,
                     f.top, f.width(), f.height());
  svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
                     f.left + 0.5 * f.width(), f.bottom + kBelowFrame - 6.0, escape_html(plot.x_label));
  const double middle = f.top + 0.5 * f.height();
  svg += fmt::format(
      R"svg(<text x="12" y="{0:.1f}" text-anchor="middle" transform="rotate(-90 12 {0:.1f})">{1}</text>)svg",
      middle, escape_html(plot.y_label));
}

void draw_backdrop(const Backdrop& b, const Frame& f, std::string& svg) {
  svg += fmt::format(
      R"(<image x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" preserveAspectRatio="none" href="{}"/>)",
      f.px(b.x_min), f.py(b.y_max), f.px(b.x_max) - f.px(b.x_min), f.py(b.y_min) - f.py(b.y_max), b.data_uri);
}

void draw_bands(const Plot& plot, const Frame& f, std::string& svg) {
  for (const Band& band : plot.bands) {
    if (!std::isfinite(band.x_min) || !std::isfinite(band.x_max) || band.x_max < band.x_min) continue;
    svg += fmt::format(
        R"(<rect class="band" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}" fill-opacity="{}"/>)",
        f.px(band.x_min), f.top, f.px(band.x_max) - f.px(band.x_min), f.height(), band.colour, kBandOpacity);
  }
}

void draw_line(const Series& series, const Frame& f, std::string& svg) {
  std::string path;
  bool pen_down = false;
  for (const std::size_t i : thin(series.y, kMaxPoints)) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
      pen_down = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', f.px(series.x[i]), f.py(series.y[i]));
    pen_down = true;
  }
  svg += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.6" stroke-linejoin="round"/>)",
                     path, series.colour);
}

void draw_dots(const Series& series, const Frame& f, std::string& svg) {
  for (const std::size_t i : thin(series.y, kMaxPoints)) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    svg += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}"/>)", f.px(series.x[i]),
                       f.py(series.y[i]), series.colour);
  }
}

}  // namespace

std::string draw(const Plot& plot) {
  std::string body;
  const std::vector<LegendEntry> legend = legend_of(plot);
  const double legend_bottom = legend.empty() ? 18.0 : draw_legend(legend, plot.width, body);
  const Frame frame = lay_out(plot, legend_bottom);
  draw_bands(plot, frame, body);
  draw_axes(plot, frame, body);
  if (plot.backdrop) draw_backdrop(*plot.backdrop, frame, body);
  for (const Series& series : plot.series) {
    if (series.style == Series::Style::kLine) {
      draw_line(series, frame, body);
    } else {
      draw_dots(series, frame, body);
    }
  }
  const std::string title = escape_html(plot.title);
  return fmt::format(
             R"(<svg viewBox="0 0 {0} {1:.0f}" role="img" aria-label="{2}"><text class="title" x="58" y="15">{2}</text>{3}</svg>)",
             plot.width, frame.bottom + kBelowFrame, title, body) +
         "\n";
}

}  // namespace edgesplat::report
