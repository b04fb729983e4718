// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/processor_clock.hpp"
#include "tools/desk/train_job.hpp"
#include "tools/desk/verbs.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <map>
#include <memory>
#include <string>

namespace edgesplat::desk {
namespace {

using nlohmann::json;

json or_null(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

double rate_hz(const TrainReport& report) {
  return report.train_seconds > 0.0 ? static_cast<double>(report.iterations) / report.train_seconds : 0.0;
}

json to_json(const TrainReport& report, const TrainJob& job) {
  const auto mean = [&report](auto field) {
    return report.held_out_means ? json((*report.held_out_means).*field) : json(nullptr);
  };
  return {{"map", job.out.string()},
          {"psnr_db", mean(&HeldOutMeans::psnr_db)},
          {"ssim", mean(&HeldOutMeans::ssim)},
          {"lpips", or_null(report.held_out_means ? report.held_out_means->lpips : std::nullopt)},
          {"train_seconds", report.train_seconds},
          {"iterations", report.iterations},
          {"iterations_per_s", rate_hz(report)},
          {"gaussians", report.gaussians},
          {"peak_rss_mb", report.peak_rss_mb},
          {"render_ms", mean(&HeldOutMeans::render_ms)},
          {"pictures", report.pictures},
          {"held_out", report.held_out},
          {"images_missing", report.images_missing},
          {"start_points", report.start_points},
          {"triangulated", report.triangulated},
          {"width_px", report.width_px},
          {"height_px", report.height_px}};
}

void print_words(const TrainReport& report, const TrainJob& job) {
  std::fprintf(stderr, "%s: %zu Gaussians after %llu iterations in %.1f s (%.1f a second), %.0f MB at most\n",
               job.out.c_str(), report.gaussians, static_cast<unsigned long long>(report.iterations),
               report.train_seconds, rate_hz(report), report.peak_rss_mb);
  if (report.images_missing > 0) {
    std::fprintf(stderr, "%zu frames of the scene have no image and were left out\n", report.images_missing);
  }
  if (!report.held_out_means) return;
  const HeldOutMeans& means = *report.held_out_means;
  std::fprintf(stderr, "%zu held-out pictures of %dx%d: PSNR %.2f dB, SSIM %.3f", report.held_out,
               report.width_px, report.height_px, means.psnr_db, means.ssim);
  if (means.lpips) std::fprintf(stderr, ", LPIPS %.3f", *means.lpips);
  std::fprintf(stderr, "\n");
}

struct TrainVerbOptions {
  TrainJob job;
  bool processor_time = false;
  bool json = false;
};

Status run_train(const TrainVerbOptions& options) {
  const TrainJob& job = options.job;
  const SteadyClock wall;
  const ProcessorClock processor;
  const TrainClocks clocks{wall, options.processor_time ? static_cast<const Clock&>(processor) : wall};
  const bool for_people = ::isatty(STDERR_FILENO) != 0;
  EDGESPLAT_TRY(const TrainReport report, run_train_job(job, clocks, [for_people](const TrainingProgress& p) {
                  if (!for_people) return;
                  std::fprintf(stderr, "\r%8.1f s, iteration %llu, %zu Gaussians, loss %.4f ", p.seconds,
                               static_cast<unsigned long long>(p.iterations), p.gaussians, p.loss);
                }));
  if (for_people) std::fprintf(stderr, "\n");
  if (options.json) {
    std::printf("%s\n", to_json(report, job).dump(-1, ' ', false, json::error_handler_t::replace).c_str());
  } else {
    print_words(report, job);
  }
  return {};
}

constexpr const char* kScenes = R"(Scenes:
  nerfstudio: transforms.json with frames (file_path, transform_matrix) and, if there is one, the name of a
    point cloud (ply_file_path) and depth pictures (depth_file_path: PNGs of 16 bits).
  COLMAP: sparse/0 (or sparse, colmap/sparse/0) with cameras, images and points3D as .bin or .txt, and the
    images in images/. Camera models: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV
    (k4 = k5 = k6 = 0) and the fisheyes without thin prism. Images larger or smaller than their cameras
    (--images DIR/images_4) are taken as they are.
Pictures are undistorted. Training begins with the points of the scene; where it has none, they come from
features of the pictures. Every 8th picture (in COLMAP's order of names) is held out and scored.

Example: edgesplat train --scene DIR --seconds 300 --out map.ply --renders looks
)";

/// Shares of the training, 0..1, and what weighs how much.
void add_schedule_options(CLI::App& verb, TrainJob& job) {
  TrainingOptions& training = job.training;
  mapping::ScheduleOptions& schedule = training.schedule;
  const auto add = [&verb](const char* name, auto& value, const char* words) {
    verb.add_option(name, value, words)->capture_default_str()->group("Schedule");
  };
  add("--coarse-until", schedule.coarse_until, "Pictures of half the size up to here");
  add("--sh-from", schedule.sh_from, "One colour a Gaussian up to here, then SH");
  add("--sh-every", schedule.sh_every, "One more degree of SH after so much");
  add("--cool-from", schedule.cool_from, "Rates fall from here on");
  add("--cool-to", schedule.cool_to, "... to this share of themselves");
  add("--grow-from", schedule.grow_from, "Gaussians are added and removed from here on");
  add("--grow-until", schedule.grow_until, "... up to here");
  add("--loss-views", training.views.loss_share, "Extra turns of badly shown pictures, as a share of all");
  add("--densify-every", training.densify_every, "Iterations from one growth to the next");
  add("--fill-gaps", training.fill_gaps, "Start with Gaussians where pictures see what no point stands for");
  add("--exposure", training.learn_exposure, "Learn the gain and offset of each picture");
  add("--rates", training.rate_factor, "Factor of all learning rates");
  add("--depth", training.depth_factor, "Weight of the depth loss, where the scene has depth");
  verb.add_option("--depth-unit", job.pictures.depth_unit_m, "Of the depth pictures' values, m")
      ->check(CLI::Range(1e-6, 10.0))
      ->capture_default_str()
      ->group("Schedule");
  add("--opacity-cost", training.opacity_factor, "Weight of the mean opacity");
  add("--scale-cost", training.scale_factor, "Weight of the mean scale, in shares of the scene's extent");
  add("--prune", training.prune_factor, "Weight of the mean switch (differentiable pruning); 0: no switches");
  add("--start-opacity", training.start_opacity, "Opacity of what is made of the points");
}

}  // namespace

void add_train_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("train", "Fit a map of Gaussians to the pictures of a scene");
  auto options = std::make_shared<TrainVerbOptions>();
  TrainJob* job = &options->job;
  TrainingOptions& training = job->training;
  job->lpips_model = "../shared/models/lpips_alex";
  verb->footer(kScenes);
  verb->add_option("--scene", job->scene, "Folder of nerfstudio's or COLMAP's, see below")->required();
  verb->add_option("--images", job->pictures.images,
                   "Folder of a COLMAP scene's images; default: its images/");
  verb->add_option("--out", job->out, "Map to write: .ply, .spz or .splat")->required();
  verb->add_option("--iterations", training.iterations, "End after so many pictures");
  verb->add_option("--seconds", training.seconds, "End after so much training")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--holdout", job->holdout, "Frames 0, N, 2 N, ... are held out and scored; 0: none")
      ->capture_default_str();
  verb->add_option("--renders", job->renders,
                   "Folder for what the held-out cameras show, beside the real pictures");
  verb->add_option("--downscale", job->pictures.downscale, "Make pictures so much smaller; 0: by --max-side")
      ->check(CLI::Range(0.0, 32.0));
  verb->add_option("--max-side", job->pictures.max_side_px, "Longer side of the pictures at most, px")
      ->check(CLI::Range(32, 16384))
      ->capture_default_str();
  verb->add_option("--sh-degree", training.schedule.sh_degree, "Spherical harmonics of the colours")
      ->check(CLI::Range(0, 3))
      ->capture_default_str();
  verb->add_option("--max-gaussians", training.max_gaussians,
                   "Size of the map at most; 0: by the pictures' size")
      ->check(CLI::Range(0, 100'000'000))
      ->capture_default_str();
  verb->add_option("--densify", training.densify, "gradient (3DGS) or mcmc")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Densify>{{"gradient", Densify::kGradient}, {"mcmc", Densify::kMcmc}}));
  add_schedule_options(*verb, *job);
  verb->add_option("--lpips", job->lpips_model, "Folder of the LPIPS network; without it there is no LPIPS")
      ->envname("EDGESPLAT_LPIPS")
      ->capture_default_str();
  verb->add_option("--curve", job->curve, "CSV for the held-out quality over training time");
  verb->add_flag("--processor-time", options->processor_time,
                 "Seconds are of processor time over all cores: for figures on a busy machine");
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_train(*options); }; });
}

}  // namespace edgesplat::desk
