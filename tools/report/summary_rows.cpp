// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/summary.hpp"

#include <fmt/format.h>

namespace edgesplat::report {
namespace {

constexpr double kBytesPerMb = 1e6;

std::string text_or_dash(const std::optional<double>& value, const char* unit, int decimals) {
  if (!value) return "-";
  return fmt::format("{:.{}f}", *value, decimals) + (*unit == '\0' ? "" : " ") + unit;
}

std::string mode_text(const LinkFigures& link) {
  if (!link.modes) return "-";
  std::string text;
  for (const RunMode mode : {RunMode::kLocal, RunMode::kLean, RunMode::kFull}) {
    text += fmt::format("{} {:.1f} s, ", kRunModeNames[index_of(mode)], link.modes->seconds[index_of(mode)]);
  }
  return text + fmt::format("{} {}", link.modes->switches, link.modes->switches == 1 ? "switch" : "switches");
}

std::string hash_text(const LinkFigures& link) {
  if (!link.map_hash_match) return "never compared";
  return fmt::format("{}, {:.0f} of {:.0f} comparisons agreed", *link.map_hash_match ? "equal" : "DIFFERENT",
                     link.hash_agreed, link.hash_agreed + link.hash_disagreed);
}

}  // namespace

std::vector<SummaryRow> summary_rows(const Summary& s) {
  const auto megabytes = [](const std::optional<double>& bytes) {
    return bytes ? std::optional<double>(*bytes / kBytesPerMb) : std::nullopt;
  };
  std::string track = text_or_dash(s.track_ms_p50, "ms median", 1);
  if (s.track_ms_p95) track += fmt::format(", {:.1f} ms p95", *s.track_ms_p95);
  std::string stream = text_or_dash(s.pose_stream_hz, "Hz", 0);
  if (s.pose_latency_ms_p50)
    stream += fmt::format(", {:.2f} ms after the sample (median)", *s.pose_latency_ms_p50);
  if (s.pose_latency_ms_p99) stream += fmt::format(", {:.1f} ms p99", *s.pose_latency_ms_p99);
  std::string end_to_end = text_or_dash(s.ete_m, "m", 3);
  if (s.ete_percent) end_to_end += fmt::format(" ({:.2f} % of the path)", *s.ete_percent);
  std::string quality = text_or_dash(s.render_psnr_db, "dB", 1);
  if (s.render_coverage) quality += fmt::format(" over {:.0f} % of the picture", 100.0 * *s.render_coverage);
  std::string held_out = text_or_dash(s.psnr_db, "dB", 1);
  if (s.real_pictures_held_out && s.static_share) {
    held_out += fmt::format(" over {:.0f} % of the pixels", 100.0 * *s.static_share);
  }
  if (s.psnr_seeded_db) held_out += fmt::format(", {:.1f} before optimising", *s.psnr_seeded_db);
  if (s.psnr_nearest_db) held_out += fmt::format(", nearest keyframe {:.1f}", *s.psnr_nearest_db);
  return {
      {"Run", fmt::format("{:.1f} s, {} poses, {}", s.duration_s, s.poses, text_or_dash(s.path_m, "m", 1))},
      {"Trajectory error (ATE rmse)", text_or_dash(s.ate_rmse_m, "m", 3)},
      {"Error at the end (ETE)", end_to_end},
      {"Tracking time per group", track},
      {"Poses at the IMU's rate", stream},
      {"Real-time factor", text_or_dash(s.realtime_factor, "x", 1)},
      {"Packets lost", text_or_dash(s.packets_lost, "", 0)},
      {"Keyframes", text_or_dash(s.keyframes, "", 0)},
      {"Gaussians on the robot", text_or_dash(s.gaussians, "", 0)},
      {s.real_pictures_held_out ? "Map at held-out pictures (PSNR)" : "Map between keyframes (PSNR)",
       held_out},
      {"Render beside camera (PSNR)", quality},
      {"Render time", text_or_dash(s.render_fps_p50, "pictures/s median", 0) +
                          (s.render_ms_p95 ? fmt::format(", {:.1f} ms p95", *s.render_ms_p95) : "")},
      {"Sent up / down",
       text_or_dash(megabytes(s.bytes_up), "MB", 1) + " / " + text_or_dash(megabytes(s.bytes_down), "MB", 1)},
      {"Time in each mode", mode_text(s.link)},
      {"Map hashes robot / server", hash_text(s.link)},
      {"Peak memory robot / server",
       text_or_dash(s.robot_peak_rss_mb, "MB", 0) + " / " + text_or_dash(s.server_peak_rss_mb, "MB", 0)}};
}

}  // namespace edgesplat::report
