// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/report/link_figures.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/references.hpp"
#include "tools/report/run_folder.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::report {

/// The run in numbers. Nothing where a figure does not apply or its source is missing.
struct Summary {
  double duration_s = 0.0;
  std::size_t poses = 0;
  std::optional<double> ate_rmse_m;  ///< against the first reference
  std::optional<double> ete_m;
  std::optional<double> ete_percent;
  std::optional<double> path_m;  ///< of the reference, else of the estimate
  std::optional<double> track_ms_p50;
  std::optional<double> track_ms_p95;
  std::optional<double> pose_stream_hz;       ///< poses at the IMU's rate
  std::optional<double> pose_latency_ms_p50;  ///< from a sample's arrival to its pose; live runs
  std::optional<double> pose_latency_ms_p99;
  std::optional<double> realtime_factor;  ///< recorded seconds per second of work of the busier stage
  std::optional<double> packets_lost;
  std::optional<double> gaussians;
  std::optional<double> keyframes;
  std::optional<double> bytes_up;
  std::optional<double> bytes_down;
  LinkFigures link;
  std::optional<double> robot_peak_rss_mb;
  std::optional<double> server_peak_rss_mb;
  bool real_pictures_held_out = false;    ///< what the next figures are against; else the clean world
  std::optional<double> static_share;     ///< of the pixels, those that count in them
  std::optional<double> psnr_db;          ///< the map from places that no keyframe was taken from
  std::optional<double> ssim;             ///< of the same pictures
  std::optional<double> lpips;            ///< of the same pictures
  std::optional<double> psnr_seeded_db;   ///< the same map before it was optimised
  std::optional<double> psnr_nearest_db;  ///< the nearest keyframe's picture instead of the map
  std::optional<double> render_fps_p50;   ///< the robot's renderer, by its own time for a picture
  std::optional<double> render_ms_p95;
  std::optional<double> render_psnr_db;  ///< Gaussians against the camera where they cover the picture, mean
  std::optional<double>
      render_coverage;  ///< share of the picture they cover, mean over the sampled keyframes
};

/// `qualities`: of the sampled renders, may be empty.
[[nodiscard]] Summary summarise(const RunFolder& run, const std::vector<Reference>& references,
                                const std::vector<RenderQuality>& qualities);

/// Keys as above, null for what does not apply, and "references": one object for each.
[[nodiscard]] nlohmann::json to_json(const Summary& summary, const std::vector<Reference>& references);

struct SummaryRow {
  std::string label;
  std::string value;  ///< with its unit, "-" for nothing
};
[[nodiscard]] std::vector<SummaryRow> summary_rows(const Summary& summary);

/// The value below which `fraction` of the finite values lie (nearest rank); nothing for none.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double fraction);

}  // namespace edgesplat::report
