// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/train_job.hpp"

#include "common/io/gaussian_file.hpp"
#include "common/metrics/process_usage.hpp"
#include "tools/desk/convert.hpp"
#include "tools/desk/quality_curve.hpp"
#include "tools/desk/scene_start.hpp"
#include "tools/quality/load_where_there.hpp"

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
      return fail(Errc::kInvalidArgument, "the scene has no point cloud, and its pictures give only " +
                                              std::to_string(scene.points.points_m.size()) +
                                              " points: name one in its transforms.json (\"ply_file_path\") "
                                              "or put points3D.bin, .txt or .ply "
                                              "beside COLMAP's cameras, in the frame of the poses");
    }
  }
  report.start_points = scene.points.points_m.size();
  return {};
}

/// Trains; where the job wants a curve, the map is scored meanwhile.
Result<TrainedMap> train(const TrainJob& job, const Split& split, const io::PointCloud& points,
                         quality::Lpips* lpips, const TrainClocks& clocks,
                         const std::function<void(const TrainingProgress&)>& tell) {
  TrainingWatch watch{tell, {}, {}};
  std::optional<QualityCurve> curve;
  if (!job.curve.empty()) {
    EDGESPLAT_TRY(curve, QualityCurve::create(job.curve));
    watch.look_at_s = curve_times_s();
    watch.look = [&](const TrainingProgress& at, const gaussian::GaussianCloud& map) -> Status {
      EDGESPLAT_TRY(const HeldOutMeans means, score_pictures(map, split.held_out, lpips, {}, clocks.wall));
      return curve->add(at, means);
    };
  }
  return train_map(split.train, points, job.training, clocks.training, watch);
}

}  // namespace

Result<TrainReport> run_train_job(const TrainJob& job, const TrainClocks& clocks,
                                  const std::function<void(const TrainingProgress&)>& tell) {
  if (const auto format = io::gaussian_format_of(job.out); !format) {
    return fail(Errc::kInvalidConfig, format.error().context);  // before the work, not after it
  }
  EDGESPLAT_TRY_STATUS(job.training.validate());
  if (!job.curve.empty() && job.holdout == 0) {
    return fail(Errc::kInvalidConfig, "a curve needs held-out pictures: give a holdout above 0");
  }
  SceneOptions pictures = job.pictures;
  pictures.depth = job.training.depth_factor > 0.0F;  // nobody looks at it else
  EDGESPLAT_TRY(Scene scene, read_scene(job.scene, pictures));
  const Split split = split_pictures(scene, job.holdout);
  TrainReport report;
  report.pictures = split.train.size();
  report.held_out = split.held_out.size();
  report.images_missing = scene.images_missing;
  report.width_px = scene.pictures.front().camera.width_px;
  report.height_px = scene.pictures.front().camera.height_px;
  EDGESPLAT_TRY_STATUS(take_start_points(split.train, scene, report));
  EDGESPLAT_TRY(auto network, quality::load_where_there<quality::Lpips>(job.lpips_model));
  quality::Lpips* lpips = network ? &*network : nullptr;
  EDGESPLAT_TRY(const TrainedMap trained, train(job, split, scene.points, lpips, clocks, tell));
  report.iterations = trained.iterations;
  report.train_seconds = trained.seconds;
  report.gaussians = trained.map.size();
  io::MapSidecar sidecar;
  sidecar.frame = "scene";
  sidecar.axes = "those of the scene's poses";
  sidecar.sky_included = true;
  EDGESPLAT_TRY(sidecar, save_map(job.out, trained.map, sidecar));
  EDGESPLAT_TRY(const auto written, io::read_gaussians(job.out));
  if (!split.held_out.empty()) {
    EDGESPLAT_TRY(report.held_out_means,
                  score_pictures(written, split.held_out, lpips, job.renders, clocks.wall));
  }
  report.peak_rss_mb = static_cast<double>(metrics::process_usage().peak_rss_bytes) / 1e6;
  return report;
}

}  // namespace edgesplat::desk
