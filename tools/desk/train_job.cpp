// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/train_job.hpp"

#include "common/io/gaussian_file.hpp"
#include "common/io/image_file.hpp"
#include "common/metrics/process_usage.hpp"
#include "tools/desk/convert.hpp"
#include "tools/desk/render_set.hpp"
#include "tools/desk/scene_start.hpp"
#include "tools/quality/load_where_there.hpp"
#include "tools/quality/picture_score.hpp"

#include <utility>

namespace edgesplat::desk {
namespace {

constexpr std::size_t kLeastTriangulated = 100;

using Pictures = std::vector<const ScenePicture*>;

struct Split {
  Pictures train, held_out;
};
Split split_pictures(const Scene& scene, std::size_t holdout) {
  Split split;
  for (std::size_t i = 0; i < scene.pictures.size(); ++i) {
    const bool held_out = holdout > 0 && i % holdout == 0;
    (held_out ? split.held_out : split.train).push_back(&scene.pictures[i]);
  }
  return split;
}

Status take_start_points(const Pictures& pictures, Scene& scene, TrainReport& report) {
  if (scene.points.points_m.empty()) {
    report.triangulated = true;
    EDGESPLAT_TRY(scene.points, triangulate(pictures));
    if (scene.points.points_m.size() < kLeastTriangulated) {
      return fail(
          Errc::kInvalidArgument,
          "the scene has no point cloud, and its pictures give only " +
              std::to_string(scene.points.points_m.size()) +
              " points: name one in its transforms.json (\"ply_file_path\"), in the frame of the poses");
    }
  }
  report.start_points = scene.points.points_m.size();
  return {};
}

/// Draws the held-out cameras from the map and compares with their pictures.
Status score_held_out(const TrainJob& job, const gaussian::GaussianCloud& map, const Pictures& held_out,
                      const Clock& clock, TrainReport& report) {
  if (held_out.empty()) return {};
  EDGESPLAT_TRY(auto lpips, quality::load_where_there<quality::Lpips>(job.lpips_model));
  if (!job.renders.empty()) {
    std::error_code error;
    std::filesystem::create_directories(job.renders, error);
    if (error)
      return fail(Errc::kIo, "cannot make the folder " + job.renders.string() + ": " + error.message());
  }
  quality::PictureScore sum{0.0, 0.0, lpips ? std::optional(0.0) : std::nullopt};
  double sum_ms = 0.0;
  for (const ScenePicture* picture : held_out) {
    const io::PosedCamera camera{picture->name, {}, picture->camera, picture->map_from_camera};
    EDGESPLAT_TRY(const RenderedView view, render_view(map, camera, {}, clock));
    EDGESPLAT_TRY(const auto score, quality::score_picture(view.picture, picture->picture, picture->weight,
                                                           lpips ? &*lpips : nullptr));
    sum.psnr_db += score.psnr_db;
    sum.ssim += score.ssim;
    if (sum.lpips) *sum.lpips += score.lpips.value_or(0.0);
    sum_ms += view.render_ms;
    if (job.renders.empty()) continue;
    EDGESPLAT_TRY_STATUS(io::save_image(job.renders / (picture->name + ".png"), view.picture));
    EDGESPLAT_TRY_STATUS(io::save_image(job.renders / (picture->name + "_real.png"), picture->picture));
  }
  const double share = 1.0 / static_cast<double>(held_out.size());
  report.psnr_db = sum.psnr_db * share;
  report.ssim = sum.ssim * share;
  if (sum.lpips) report.lpips = *sum.lpips * share;
  report.render_ms = sum_ms * share;
  return {};
}

}  // namespace

Result<TrainReport> run_train_job(const TrainJob& job, const Clock& clock,
                                  const std::function<void(const TrainingProgress&)>& tell) {
  if (const auto format = io::gaussian_format_of(job.out); !format) {
    return fail(Errc::kInvalidConfig, format.error().context);  // before the work, not after it
  }
  EDGESPLAT_TRY_STATUS(job.training.validate());
  EDGESPLAT_TRY(Scene scene, read_scene(job.scene, job.pictures));
  const Split split = split_pictures(scene, job.holdout);
  TrainReport report;
  report.pictures = split.train.size();
  report.held_out = split.held_out.size();
  report.images_missing = scene.images_missing;
  report.width_px = scene.pictures.front().camera.width_px;
  report.height_px = scene.pictures.front().camera.height_px;
  EDGESPLAT_TRY_STATUS(take_start_points(split.train, scene, report));
  EDGESPLAT_TRY(const TrainedMap trained, train_map(split.train, scene.points, job.training, clock, tell));
  report.iterations = trained.iterations;
  report.train_seconds = trained.seconds;
  report.gaussians = trained.map.size();
  io::MapSidecar sidecar;
  sidecar.frame = "scene";
  sidecar.axes = "those of the scene's transforms.json";
  sidecar.sky_included = true;
  EDGESPLAT_TRY(sidecar, save_map(job.out, trained.map, sidecar));
  EDGESPLAT_TRY(const auto written, io::read_gaussians(job.out));
  EDGESPLAT_TRY_STATUS(score_held_out(job, written, split.held_out, clock, report));
  report.peak_rss_mb = static_cast<double>(metrics::process_usage().peak_rss_bytes) / 1e6;
  return report;
}

}  // namespace edgesplat::desk
