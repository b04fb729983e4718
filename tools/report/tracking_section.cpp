// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/patch_picture.hpp"
#include "tools/report/run_metrics.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace edgesplat::report {
namespace {

struct StateStyle {
  const char* name;
  const char* colour;
};
/// As health_csv names them; what needs a look stands out.
constexpr std::array<StateStyle, 6> kStates{{{"initialising", "#b0b0b0"},
                                             {"tracking", "none"},
                                             {"degraded", kOrange},
                                             {"coasting", kPurple},
                                             {"lost", kRed},
                                             {"recovered", kBlue}}};

struct Groups {
  std::vector<double> seconds;  ///< since the first one
  std::vector<std::string> states;
};

Groups groups_of(const CsvTable& table) {
  Groups groups{table.numbers("stamp_s"), table.texts("state")};
  if (groups.states.size() != groups.seconds.size()) return {};
  const double start = groups.seconds.empty() ? 0.0 : groups.seconds.front();
  for (double& second : groups.seconds) second -= start;
  return groups;
}

/// From each group to the next the state is the first one's.
std::vector<Band> state_bands(const Groups& groups) {
  std::vector<Band> bands;
  for (std::size_t i = 0; i + 1 < groups.seconds.size(); ++i) {
    const auto* style =
        std::ranges::find_if(kStates, [&](const StateStyle& s) { return groups.states[i] == s.name; });
    if (style == kStates.end() || std::string_view(style->colour) == "none") continue;
    const bool goes_on =
        !bands.empty() && bands.back().name == style->name && bands.back().x_max == groups.seconds[i];
    if (goes_on) {
      bands.back().x_max = groups.seconds[i + 1];
    } else {
      bands.push_back({style->name, style->colour, groups.seconds[i], groups.seconds[i + 1]});
    }
  }
  return bands;
}

std::string states_text(const Groups& groups) {
  std::string text;
  for (const StateStyle& style : kStates) {
    double seconds = 0.0;
    for (std::size_t i = 0; i + 1 < groups.seconds.size(); ++i)
      if (groups.states[i] == style.name) seconds += groups.seconds[i + 1] - groups.seconds[i];
    if (seconds > 0.0) text += fmt::format("{}{} {:.1f} s", text.empty() ? "" : ", ", style.name, seconds);
  }
  return text;
}

struct Column {
  const char* name;
  const char* legend;
  const char* colour;
};
/// A plot of those columns that there are; empty where there is none.
std::string plot_of(const CsvTable& table, const Groups& groups, Plot plot,
                    std::initializer_list<Column> columns) {
  for (const Column& column : columns) {
    if (!table.has(column.name)) continue;
    plot.series.push_back({column.legend, column.colour, groups.seconds, table.numbers(column.name)});
  }
  if (plot.series.empty()) return "";
  plot.bands = state_bands(groups);
  plot.include_zero = true;
  return draw(plot);
}

/// What the camera's own pictures say about its clock, and how far the devices' clocks are apart.
std::string offsets_table(const nlohmann::json& metrics) {
  std::vector<std::vector<std::string>> rows = {{"clock", "offset, ms", "drift, ppm", "jitter, us"}};
  const auto text = [](const std::optional<double>& value, double scale, int decimals) {
    return value ? fmt::format("{:.{}f}", *value * scale, decimals) : "-";
  };
  for (const char* device : {"points", "imu", "camera"}) {
    const std::string prefix = fmt::format("sync.{}.", device);
    const auto offset_s = find_metric(metrics, {prefix + "offset_s"});
    if (!offset_s) continue;
    rows.push_back({device, text(offset_s, 1e3, 3),
                    text(find_metric(metrics, {prefix + "drift_ppm"}), 1.0, 2),
                    text(find_metric(metrics, {prefix + "jitter_us"}), 1.0, 1)});
  }
  if (const auto seen_ms = find_metric(metrics, {"sync.camera_offset_ms"}))
    rows.push_back({"camera, by what it sees", text(seen_ms, 1.0, 2), "-", "-"});
  return rows.size() > 1 ? html_table(rows) : "";
}

/// What tracking found of delays and mounting; empty where all of it is held.
std::string found_offsets_table(const nlohmann::json& metrics) {
  std::vector<std::vector<std::string>> rows = {
      {"found by tracking", "value", "1 sigma", "held by the motion"}};
  const auto value = [&](const std::string& name) {
    return find_metric(metrics, {"tracking." + name}).value_or(0.0);
  };
  for (const auto& [device, name] : {std::pair{"lidar", "LiDAR"}, {"camera", "camera"}}) {
    const std::string prefix = fmt::format("{}_delay_", device);
    if (!(value(prefix + "sigma_ms") > 0.0)) continue;
    rows.push_back({fmt::format("{} later than its stamps, ms", name),
                    fmt::format("{:.2f}", value(prefix + "ms")),
                    fmt::format("{:.2f}", value(prefix + "sigma_ms")),
                    value(prefix + "frozen") > 0.0 ? "at the end" : "no"});
  }
  for (const auto& [part, name, unit] :
       {std::tuple{"lidar_turn", "LiDAR turned against the rig's", "mrad"}, {"lidar_step", "moved", "mm"}}) {
    const double sigma = value(fmt::format("{}_sigma_{}", part, unit));
    if (!(sigma > 0.0)) continue;
    const auto axis = [&](char name_of_axis) {
      return value(fmt::format("{}_{}_{}", part, name_of_axis, unit));
    };
    rows.push_back({fmt::format("{} (x, y, z of the body), {}", name, unit),
                    fmt::format("{:.1f}, {:.1f}, {:.1f}", axis('x'), axis('y'), axis('z')),
                    fmt::format("{:.1f} (all three)", sigma),
                    fmt::format("{:.0f} of 3 directions at the end", value(fmt::format("{}_frozen", part)))});
  }
  return rows.size() > 1 ? html_table(rows) : "";
}

Result<std::string> picture_with_patches(const KeyframeFiles& files) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 20U;
  EDGESPLAT_TRY(const std::string text, io::read_text_file(files.patches, kMostBytes));
  EDGESPLAT_TRY(const CsvTable patches, CsvTable::parse(text, files.patches.filename().string()));
  EDGESPLAT_TRY(const sensor::ImageRgb8 picture, io::load_rgb8(files.image));
  return patch_picture(picture, patches, "keyframe " + files.number);
}

}  // namespace

std::vector<std::string> patch_pictures(RunFolder& run, std::size_t limit) {
  std::vector<const KeyframeFiles*> with_patches;
  for (const KeyframeFiles& files : run.keyframes)
    if (!files.patches.empty()) with_patches.push_back(&files);
  std::vector<std::string> pictures;
  const std::size_t count = std::min(limit, with_patches.size());
  for (std::size_t i = 0; i < count; ++i) {
    auto picture = picture_with_patches(*with_patches[(i + 1) * with_patches.size() / count - 1]);
    if (picture) {
      pictures.push_back(*std::move(picture));
    } else {
      run.missing.push_back(picture.error().context);
    }
  }
  return pictures;
}

std::string tracking_section(const RunFolder& run, const std::vector<std::string>& patch_pictures) {
  const CsvTable& table = run.groups;
  const Groups groups = groups_of(table);
  const std::string found = found_offsets_table(run.robot_metrics);
  std::vector<std::string> plots;
  if (!groups.seconds.empty()) {
    plots = {
        plot_of(table, groups, {"How well the LiDAR sees the least seen direction", "time (s)", "signal", {}},
                {{"weakest_signal", "1: nothing but noise", kBlue}}),
        plot_of(table, groups, {"Directions left to the IMU", "time (s)", "of six", {}},
                {{"frozen_directions", "not seen", kRed}}),
        plot_of(table, groups, {"Patches that the picture was aligned with", "time (s)", "patches", {}},
                {{"visual_patches", "patches", kGreen}}),
        plot_of(table, groups, {"Brightness of the pictures", "time (s)", "ln of the gain", {}},
                {{"log_gain", "against the first picture", kOrange}})};
    if (!found.empty())
      plots.push_back(plot_of(table, groups, {"Delays against the IMU", "time (s)", "ms", {}},
                              {{"lidar_delay_ms", "LiDAR", kBlue}, {"camera_delay_ms", "camera", kGreen}}));
    std::erase_if(plots, [](const std::string& plot) { return plot.empty(); });
  }
  std::string body;
  if (const std::string states = states_text(groups); !states.empty())
    body += html_paragraph("States: " + states + ". Coloured stretches: not simply tracking.");
  if (!plots.empty()) body += html_grid(plots);
  if (!patch_pictures.empty()) {
    body += html_paragraph(
        "Patches of the visual map where tracking expected them in the picture, coloured by how far they are "
        "from "
        "looking as they did before: the farther, the less they count. Crossed out: left out.");
    body += html_grid(patch_pictures);
  }
  body += offsets_table(run.robot_metrics) + found;
  if (body.empty()) body = html_paragraph("The run says nothing about its tracking.");
  return html_section("What tracking saw", body);
}

}  // namespace edgesplat::report
