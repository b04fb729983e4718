// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace edgesplat::report {
namespace {

constexpr const char* kColours[] = {kBlue, kOrange, kGreen, kRed, kPurple};

std::vector<double> seconds_since_start(const CsvTable& groups) {
  std::vector<double> stamps = groups.numbers("stamp_s");
  if (stamps.empty()) return stamps;
  const double start = stamps.front();
  for (double& stamp : stamps) stamp -= start;
  return stamps;
}

/// The stages that a group passes; what else is in ms are offsets.
std::vector<std::string> stages_of(const CsvTable& groups) {
  std::vector<std::string> columns;
  for (const char* stage : {"track_ms", "keyframe_ms", "latency_ms"})
    if (groups.has(stage)) columns.emplace_back(stage);
  return columns;
}

/// "track_ms" -> "track"
std::string stage_name(const std::string& column) {
  return column.substr(0, column.size() - 3);
}

std::string ms(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string from_json(const nlohmann::json& summary, const char* key) {
  return summary.contains(key) && summary[key].is_number() ? fmt::format("{:.2f}", summary[key].get<double>())
                                                           : "-";
}

std::string group_times_table(const CsvTable& groups) {
  std::vector<std::vector<std::string>> rows = {{"each group, ms", "p50", "p95", "p99", "max"}};
  for (const std::string& column : stages_of(groups)) {
    const auto values = groups.numbers(column);
    rows.push_back({stage_name(column), ms(percentile(values, 0.5)), ms(percentile(values, 0.95)),
                    ms(percentile(values, 0.99)), ms(percentile(values, 1.0))});
  }
  return rows.size() > 1 ? html_table(rows) : "";
}

std::string histogram_table(const nlohmann::json& metrics, const std::string& program) {
  if (!metrics.is_object() || !metrics.contains("histograms") || metrics["histograms"].empty()) return "";
  std::vector<std::vector<std::string>> rows = {{program, "count", "mean", "p50", "p95", "p99", "max"}};
  for (const auto& [name, summary] : metrics["histograms"].items()) {
    if (!summary.is_object()) continue;
    const auto count =
        summary.contains("count") && summary["count"].is_number() ? summary["count"].dump() : "-";
    rows.push_back({name, count, from_json(summary, "mean"), from_json(summary, "p50"),
                    from_json(summary, "p95"), from_json(summary, "p99"), from_json(summary, "max")});
  }
  return html_table(rows);
}

std::string times_plot(const CsvTable& groups) {
  Plot plot{"Time of each stage", "time (s)", "ms per group", {}};
  plot.include_zero = true;
  std::size_t next = 0;
  for (const std::string& column : stages_of(groups)) {
    plot.series.push_back({stage_name(column), kColours[next++ % std::size(kColours)],
                           seconds_since_start(groups), groups.numbers(column)});
  }
  return plot.series.empty() ? "" : draw(plot);
}

std::string points_plot(const CsvTable& groups) {
  Plot plot{"Points of each group", "time (s)", "points", {}};
  plot.include_zero = true;
  if (groups.has("points_in_group")) {
    plot.series.push_back(
        {"measured", kBlue, seconds_since_start(groups), groups.numbers("points_in_group")});
  }
  if (groups.has("points_used")) {
    plot.series.push_back(
        {"used for the pose", kOrange, seconds_since_start(groups), groups.numbers("points_used")});
  }
  return plot.series.empty() ? "" : draw(plot);
}

/// Groups in each whole second: 10 where the robot follows, fewer where it lost some.
std::string rate_plot(const CsvTable& groups) {
  const std::vector<double> seconds = seconds_since_start(groups);
  if (seconds.size() < 2 || !std::isfinite(seconds.back()) || seconds.back() < 2.0 || seconds.back() > 1e6)
    return "";
  std::vector<double> per_second(static_cast<std::size_t>(seconds.back()), 0.0);
  for (const double second : seconds) {
    if (second >= 0.0 && second < static_cast<double>(per_second.size())) {
      per_second[static_cast<std::size_t>(second)] += 1.0;
    }
  }
  std::vector<double> middles(per_second.size());
  std::iota(middles.begin(), middles.end(), 0.5);
  Plot plot{
      "Poses a second", "time (s)", "Hz", {{"poses", kBlue, std::move(middles), std::move(per_second)}}};
  plot.include_zero = true;
  return draw(plot);
}

std::string quality_plot(const CsvTable& groups) {
  if (!groups.has("residual_rms_m")) return "";
  std::vector<double> residuals_mm = groups.numbers("residual_rms_m");
  for (double& residual : residuals_mm) residual *= 1e3;
  Plot plot{"Distance of the points from the map's planes",
            "time (s)",
            "rms (mm)",
            {{"residual", kGreen, seconds_since_start(groups), std::move(residuals_mm)}}};
  plot.include_zero = true;
  return draw(plot);
}

}  // namespace

std::string timing_section(const RunFolder& run) {
  std::vector<std::string> plots = {times_plot(run.groups), rate_plot(run.groups), points_plot(run.groups),
                                    quality_plot(run.groups)};
  std::erase_if(plots, [](const std::string& plot) { return plot.empty(); });
  std::string body = group_times_table(run.groups);
  if (!plots.empty()) body += html_grid(plots);
  body += histogram_table(run.robot_metrics, "robot") + histogram_table(run.server_metrics, "server");
  if (body.empty()) body = html_paragraph("The run has no timings.");
  return html_section("Times and rates", body);
}

}  // namespace edgesplat::report
