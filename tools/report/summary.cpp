// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/summary.hpp"

#include "tools/report/run_metrics.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace edgesplat::report {
namespace {

constexpr double kBytesPerMb = 1e6;

double path_of_m(const std::vector<io::StampedPose>& poses) {
  double path_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path_m += (poses[i].world_from_body.translation_m - poses[i - 1].world_from_body.translation_m).norm();
  }
  return path_m;
}

std::optional<double> peak_rss_mb(const nlohmann::json& metrics) {
  if (!metrics.is_object() || !metrics.contains("process")) return std::nullopt;
  const auto& process = metrics["process"];
  if (!process.contains("peak_rss_bytes") || !process["peak_rss_bytes"].is_number()) return std::nullopt;
  return process["peak_rss_bytes"].get<double>() / kBytesPerMb;
}

/// Recorded time over the work of the busier of the two stages, which run side by side.
std::optional<double> realtime_factor(const RunFolder& run, double duration_s) {
  double busiest_ms = 0.0;
  for (const char* column : {"track_ms", "keyframe_ms"}) {
    double work_ms = 0.0;
    for (const double value : run.groups.numbers(column)) work_ms += std::isfinite(value) ? value : 0.0;
    busiest_ms = std::max(busiest_ms, work_ms);
  }
  if (busiest_ms <= 0.0 || duration_s <= 0.0) return std::nullopt;
  return duration_s / (busiest_ms / 1e3);
}

/// LiDAR datagrams that never arrived, by the gaps in the device's counters.
std::optional<double> packets_lost(const nlohmann::json& metrics) {
  std::optional<double> sum;
  if (!metrics.is_object() || !metrics.contains("counters")) return sum;
  for (const auto& [name, value] : metrics["counters"].items()) {
    if (!name.starts_with("livox.") || !name.ends_with(".lost")) continue;
    if (value.is_number()) sum = sum.value_or(0.0) + value.get<double>();
  }
  return sum;
}

nlohmann::json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

void read_held_out(const nlohmann::json& held_out, Summary& s) {
  s.real_pictures_held_out = held_out.is_object() && held_out.value("kind", nlohmann::json()) == "real";
  s.static_share = number_of(held_out, "static_share");
  s.psnr_db = number_of(held_out, "psnr_db");
  s.ssim = number_of(held_out, "ssim");
  s.lpips = number_of(held_out, "lpips");
  s.psnr_seeded_db = number_of(held_out, "psnr_seeded_db");
  s.psnr_nearest_db = number_of(held_out, "psnr_nearest_db");
}

/// The server's that the robot holds and its own.
std::optional<double> gaussians_drawn(const nlohmann::json& robot_metrics) {
  const auto held = find_metric(robot_metrics, {"map.gaussians"});
  const auto own = find_metric(robot_metrics, {"local.gaussians"});
  if (!held && !own) return std::nullopt;
  return held.value_or(0.0) + own.value_or(0.0);
}

}  // namespace

std::optional<double> percentile(std::vector<double> values, double fraction) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size())));
  return values[std::min(std::max<std::size_t>(rank, 1), values.size()) - 1];
}

Summary summarise(const RunFolder& run, const std::vector<Reference>& references,
                  const std::vector<RenderQuality>& qualities) {
  Summary s;
  s.poses = run.trajectory.size();
  if (s.poses > 1) s.duration_s = to_seconds(run.trajectory.back().stamp - run.trajectory.front().stamp);
  if (s.poses > 1) s.path_m = path_of_m(run.trajectory);
  if (!references.empty()) {
    const accuracy::Evaluation& evaluation = references.front().evaluation;
    s.ate_rmse_m = evaluation.absolute_m.rmse;
    s.ete_m = evaluation.end_to_end.distance_m;
    s.ete_percent = evaluation.end_to_end.percent_of_path;
    s.path_m = evaluation.path_m;
  }
  s.track_ms_p50 = percentile(run.groups.numbers("track_ms"), 0.50);
  s.track_ms_p95 = percentile(run.groups.numbers("track_ms"), 0.95);
  if (const auto streamed = find_metric(run.robot_metrics, {"pose_stream.poses"});
      streamed && s.duration_s > 0)
    s.pose_stream_hz = *streamed / s.duration_s;
  s.pose_latency_ms_p50 = find_histogram(run.robot_metrics, "pose_stream.latency_ms", "p50");
  s.pose_latency_ms_p99 = find_histogram(run.robot_metrics, "pose_stream.latency_ms", "p99");
  s.realtime_factor = realtime_factor(run, s.duration_s);
  s.packets_lost = packets_lost(run.robot_metrics);
  s.gaussians = gaussians_drawn(run.robot_metrics);
  s.keyframes = find_metric(run.robot_metrics, {"keyframes.made"});
  s.bytes_up = find_metric(run.robot_metrics, {"link.bytes_up"});
  s.bytes_down = find_metric(run.robot_metrics, {"link.bytes_down"});
  s.robot_peak_rss_mb = peak_rss_mb(run.robot_metrics);
  s.server_peak_rss_mb = peak_rss_mb(run.server_metrics);
  s.link = link_figures(run);
  read_held_out(run.held_out, s);
  if (const auto median = find_histogram(run.robot_metrics, "render.frame_ms", "p50");
      median && *median > 0.0) {
    s.render_fps_p50 = 1e3 / *median;
  }
  s.render_ms_p95 = find_histogram(run.robot_metrics, "render.frame_ms", "p95");
  if (!qualities.empty()) {
    RenderQuality sum;
    for (const RenderQuality& quality : qualities) {
      sum.psnr_db += quality.psnr_db;
      sum.coverage += quality.coverage;
    }
    s.render_psnr_db = sum.psnr_db / static_cast<double>(qualities.size());
    s.render_coverage = sum.coverage / static_cast<double>(qualities.size());
  }
  return s;
}

nlohmann::json to_json(const Summary& s, const std::vector<Reference>& references) {
  nlohmann::json json = {{"duration_s", s.duration_s},
                         {"poses", s.poses},
                         {"ate_rmse_m", or_null(s.ate_rmse_m)},
                         {"ete_m", or_null(s.ete_m)},
                         {"ete_percent", or_null(s.ete_percent)},
                         {"path_m", or_null(s.path_m)},
                         {"track_ms_p50", or_null(s.track_ms_p50)},
                         {"track_ms_p95", or_null(s.track_ms_p95)},
                         {"pose_stream_hz", or_null(s.pose_stream_hz)},
                         {"pose_latency_ms_p50", or_null(s.pose_latency_ms_p50)},
                         {"pose_latency_ms_p99", or_null(s.pose_latency_ms_p99)},
                         {"realtime_factor", or_null(s.realtime_factor)},
                         {"packets_lost", or_null(s.packets_lost)},
                         {"gaussians", or_null(s.gaussians)},
                         {"keyframes", or_null(s.keyframes)},
                         {"bytes_up", or_null(s.bytes_up)},
                         {"bytes_down", or_null(s.bytes_down)},
                         {"robot_peak_rss_mb", or_null(s.robot_peak_rss_mb)},
                         {"server_peak_rss_mb", or_null(s.server_peak_rss_mb)},
                         {"psnr_db", or_null(s.psnr_db)},
                         {"ssim", or_null(s.ssim)},
                         {"lpips", or_null(s.lpips)},
                         {"static_share", or_null(s.static_share)},
                         {"psnr_seeded_db", or_null(s.psnr_seeded_db)},
                         {"psnr_nearest_db", or_null(s.psnr_nearest_db)},
                         {"render_fps_p50", or_null(s.render_fps_p50)},
                         {"render_ms_p95", or_null(s.render_ms_p95)},
                         {"render_psnr_db", or_null(s.render_psnr_db)},
                         {"render_coverage", or_null(s.render_coverage)},
                         {"references", nlohmann::json::array()}};
  add_to_json(s.link, json);
  for (const Reference& reference : references) {
    const accuracy::Evaluation& e = reference.evaluation;
    json["references"].push_back({{"name", reference.name},
                                  {"pairs", e.pairs},
                                  {"path_m", e.path_m},
                                  {"ate_rmse_m", e.absolute_m.rmse},
                                  {"ate_max_m", e.absolute_m.max},
                                  {"rpe_per_metre_m", e.per_metre.translation_m.mean},
                                  {"ete_m", e.end_to_end.distance_m},
                                  {"ete_percent", e.end_to_end.percent_of_path}});
  }
  return json;
}

}  // namespace edgesplat::report
