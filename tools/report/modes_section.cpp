// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::report {
namespace {

constexpr std::array<const char*, 3> kModeColours = {kOrange, kPurple, kGreen};  // LOCAL, LEAN, FULL
constexpr std::size_t kMaxBands = 1000;

/// One curve over the time line in other units.
Series curve(const ModeTimeline& timeline, const char* name, const char* colour, double ModeSample::*value,
             double unit) {
  Series series{name, colour, {}, {}};
  for (const ModeSample& sample : timeline.samples) {
    series.x.push_back(sample.t_s);
    series.y.push_back(sample.*value / unit);
  }
  return series;
}

/// Named ones stand in the plot's legend.
std::vector<Band> bands_of(const ModeTimeline& timeline, bool named) {
  std::vector<Band> bands;
  for (const ModeSpan& span : spans_of(timeline)) {
    if (bands.size() == kMaxBands) break;
    const std::size_t mode = index_of(span.mode);
    bands.push_back({named ? kRunModeNames[mode] : "", kModeColours[mode], span.begin_s, span.end_s});
  }
  return bands;
}

/// Steps, so that the modes can be told apart without colours too.
std::string modes_plot(const ModeTimeline& timeline) {
  Series steps{"mode", kBlue, {}, {}};
  for (const ModeSpan& span : spans_of(timeline)) {
    const auto height = static_cast<double>(index_of(span.mode));
    steps.x.insert(steps.x.end(), {span.begin_s, span.end_s});
    steps.y.insert(steps.y.end(), {height, height});
  }
  Plot plot{"Mode: 0 LOCAL, 1 LEAN, 2 FULL", "time (s)", "mode", {std::move(steps)}};
  plot.bands = bands_of(timeline, true);
  plot.include_zero = true;
  return draw(plot);
}

/// Empty where no curve has a value.
std::string curves_plot(const ModeTimeline& timeline, const char* title, const char* y_label,
                        std::vector<Series> curves) {
  std::erase_if(curves, [](const Series& series) {
    return std::none_of(series.y.begin(), series.y.end(), [](double value) { return std::isfinite(value); });
  });
  if (curves.empty()) return "";
  Plot plot{title, "time (s)", y_label, std::move(curves)};
  plot.bands = bands_of(timeline, false);
  plot.include_zero = true;
  return draw(plot);
}

std::vector<std::string> plots_of(const ModeTimeline& timeline) {
  const auto of = [&](const char* name, const char* colour, double ModeSample::*value, double unit) {
    return curve(timeline, name, colour, value, unit);
  };
  std::vector<std::string> plots = {
      modes_plot(timeline),
      curves_plot(timeline, "Render latency", "ms",
                  {of("p95 of the last 2 s", kBlue, &ModeSample::render_p95_ms, 1.0)}),
      curves_plot(timeline, "Memory of the robot", "MB",
                  {of("as the decision sees it", kBlue, &ModeSample::memory_bytes, 1e6)}),
      curves_plot(timeline, "Bandwidth up", "kB/s",
                  {of("estimate", kBlue, &ModeSample::bandwidth_bytes_per_s, 1e3),
                   of("shaped to", kRed, &ModeSample::true_bandwidth_bytes_per_s, 1e3)}),
      curves_plot(
          timeline, "Bytes since the start", "MB",
          {of("up", kBlue, &ModeSample::bytes_up, 1e6), of("down", kRed, &ModeSample::bytes_down, 1e6)}),
      curves_plot(timeline, "Gaussians on the robot", "Gaussians",
                  {of("resident", kBlue, &ModeSample::gaussians, 1.0)})};
  std::erase_if(plots, [](const std::string& plot) { return plot.empty(); });
  return plots;
}

std::string kilobytes_per_s(const std::optional<double>& bytes_per_s) {
  return bytes_per_s ? fmt::format("{:.1f} kB/s", *bytes_per_s / 1e3) : "-";
}

std::string modes_table(const ModeFigures& figures) {
  std::vector<std::vector<std::string>> rows = {{"mode", "time", "bytes up, mean"}};
  for (std::size_t mode = 0; mode < kRunModeNames.size(); ++mode) {
    rows.push_back({kRunModeNames[mode], fmt::format("{:.1f} s", figures.seconds[mode]),
                    kilobytes_per_s(figures.bytes_up_per_s[mode])});
  }
  return html_table(rows);
}

/// What holds with or without a time line.
std::string link_sentence(const LinkFigures& link) {
  std::string text;
  if (link.modes) {
    text += fmt::format("Switches: {}. Mean bytes down: {}. ", link.modes->switches,
                        kilobytes_per_s(link.modes->bytes_down_per_s));
  }
  if (link.delta_latency_ms_p95)
    text += fmt::format("From keyframe to delta on the server: {:.0f} ms p95. ", *link.delta_latency_ms_p95);
  if (!link.map_hash_match) return text + "The two maps' hashes were never compared.";
  return text + fmt::format("The two maps' hashes agreed {:.0f} times and disagreed {:.0f} times.",
                            link.hash_agreed, link.hash_disagreed);
}

}  // namespace

std::string modes_section(const RunFolder& run, const LinkFigures& link) {
  std::string body;
  if (link.modes) {
    body += modes_table(*link.modes);
  } else {
    body += html_paragraph("The run has no time line of modes.");
  }
  body += html_paragraph(link_sentence(link));
  if (!run.modes.samples.empty()) body += html_grid(plots_of(run.modes));
  return html_section("Modes and link", body);
}

}  // namespace edgesplat::report
