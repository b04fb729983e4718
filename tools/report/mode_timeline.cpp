// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/mode_timeline.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace edgesplat::report {
namespace {

constexpr std::size_t kMaxLineBytes = 4096;  // the robot's have some 350
constexpr double kMaxTime_s = 1e7;
constexpr double kMaxValue = 1e15;  // a petabyte; curves beyond would not be readable

double number_or_unknown(const nlohmann::json& line, const char* key) {
  const auto found = line.find(key);
  if (found == line.end() || !found->is_number()) return ModeSample::kUnknown;
  const auto value = found->get<double>();
  return value >= 0.0 && value <= kMaxValue ? value : ModeSample::kUnknown;
}

std::optional<RunMode> mode_named(const nlohmann::json& line) {
  const auto found = line.find("mode");
  if (found == line.end() || !found->is_string()) return std::nullopt;
  const auto& name = found->get_ref<const std::string&>();
  for (const RunMode mode : {RunMode::kLocal, RunMode::kLean, RunMode::kFull}) {
    if (name == kRunModeNames[index_of(mode)]) return mode;
  }
  return std::nullopt;
}

struct ParsedLine {
  ModeSample sample;
  const char* problem = nullptr;  ///< why the line cannot be used
};

ParsedLine parse_line(std::string_view text) {
  if (text.size() > kMaxLineBytes) return {{}, "too long"};
  const nlohmann::json line = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!line.is_object()) return {{}, "not a JSON object"};
  const auto mode = mode_named(line);
  if (!mode) return {{}, "no known mode"};
  ModeSample sample;
  sample.mode = *mode;
  sample.t_s = number_or_unknown(line, "t_s");
  if (!(sample.t_s <= kMaxTime_s)) return {{}, "no time"};
  sample.render_p95_ms = number_or_unknown(line, "render_p95_ms");
  sample.memory_bytes = number_or_unknown(line, "memory_bytes");
  sample.bandwidth_bytes_per_s = number_or_unknown(line, "bandwidth_bytes_per_s");
  sample.true_bandwidth_bytes_per_s = number_or_unknown(line, "true_bandwidth_bytes_per_s");
  sample.bytes_up = number_or_unknown(line, "bytes_up");
  sample.bytes_down = number_or_unknown(line, "bytes_down");
  sample.draining = line.contains("draining") && line["draining"] == true;
  sample.gaussians = number_or_unknown(line, "gaussians");
  return {sample, nullptr};
}

/// Bytes over the seconds in which they were counted.
struct Rate {
  double bytes = 0.0;
  double seconds = 0.0;

  /// A count that is not known or goes back says nothing of its interval.
  void add(double before, double after, double duration_s) {
    if (!(after >= before)) return;
    bytes += after - before;
    seconds += duration_s;
  }
  [[nodiscard]] std::optional<double> mean() const {
    return seconds > 0.0 ? std::optional<double>(bytes / seconds) : std::nullopt;
  }
};

}  // namespace

ModeTimeline parse_mode_timeline(std::string_view text, std::string_view file_name) {
  ModeTimeline timeline;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    ParsedLine parsed = parse_line(line);
    if (parsed.problem == nullptr && !timeline.samples.empty() &&
        parsed.sample.t_s < timeline.samples.back().t_s) {
      parsed.problem = "earlier than the line before";
    }
    if (timeline.samples.size() >= ModeTimeline::kMaxSamples) parsed.problem = "too many lines";
    if (parsed.problem == nullptr) {
      timeline.samples.push_back(parsed.sample);
    } else if (timeline.skipped++ == 0) {
      timeline.first_skipped = std::string(file_name) + ":" + std::to_string(number) + ": " + parsed.problem;
    }
  }
  return timeline;
}

std::vector<ModeSpan> spans_of(const ModeTimeline& timeline) {
  std::vector<ModeSpan> spans;
  for (const ModeSample& sample : timeline.samples) {
    if (!spans.empty()) spans.back().end_s = sample.t_s;
    if (spans.empty() || spans.back().mode != sample.mode)
      spans.push_back({sample.mode, sample.t_s, sample.t_s});
  }
  return spans;
}

ModeFigures figures_of(const ModeTimeline& timeline) {
  ModeFigures figures;
  std::array<Rate, 3> up;
  Rate down;
  for (std::size_t i = 1; i < timeline.samples.size(); ++i) {
    const ModeSample& before = timeline.samples[i - 1];
    const ModeSample& after = timeline.samples[i];
    const double duration_s = after.t_s - before.t_s;
    const std::size_t mode = index_of(before.mode);
    figures.seconds[mode] += duration_s;
    figures.switches += before.mode != after.mode ? 1 : 0;
    if (!after.draining) up[mode].add(before.bytes_up, after.bytes_up, duration_s);
    down.add(before.bytes_down, after.bytes_down, duration_s);
  }
  for (std::size_t mode = 0; mode < up.size(); ++mode) figures.bytes_up_per_s[mode] = up[mode].mean();
  figures.bytes_down_per_s = down.mean();
  return figures;
}

}  // namespace edgesplat::report
