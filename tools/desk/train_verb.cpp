// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/train_job.hpp"
#include "tools/desk/verbs.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

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
  return {{"map", job.out.string()},
          {"psnr_db", or_null(report.psnr_db)},
          {"ssim", or_null(report.ssim)},
          {"lpips", or_null(report.lpips)},
          {"train_seconds", report.train_seconds},
          {"iterations", report.iterations},
          {"iterations_per_s", rate_hz(report)},
          {"gaussians", report.gaussians},
          {"peak_rss_mb", report.peak_rss_mb},
          {"render_ms", or_null(report.render_ms)},
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
  if (!report.psnr_db) return;
  std::fprintf(stderr, "%zu held-out pictures of %dx%d: PSNR %.2f dB, SSIM %.3f", report.held_out,
               report.width_px, report.height_px, *report.psnr_db, *report.ssim);
  if (report.lpips) std::fprintf(stderr, ", LPIPS %.3f", *report.lpips);
  std::fprintf(stderr, "\n");
}

Status run_train(const TrainJob& job, bool as_json) {
  const SteadyClock clock;
  const bool for_people = ::isatty(STDERR_FILENO) != 0;
  EDGESPLAT_TRY(const TrainReport report, run_train_job(job, clock, [for_people](const TrainingProgress& p) {
                  if (!for_people) return;
                  std::fprintf(stderr, "\r%8.1f s, iteration %llu, %zu Gaussians, loss %.4f ", p.seconds,
                               static_cast<unsigned long long>(p.iterations), p.gaussians, p.loss);
                }));
  if (for_people) std::fprintf(stderr, "\n");
  if (as_json) {
    std::printf("%s\n", to_json(report, job).dump(-1, ' ', false, json::error_handler_t::replace).c_str());
  } else {
    print_words(report, job);
  }
  return {};
}

}  // namespace

void add_train_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("train", "Fit a map of Gaussians to the pictures of a scene");
  auto job = std::make_shared<TrainJob>();
  auto as_json = std::make_shared<bool>(false);
  TrainingOptions& training = job->training;
  job->lpips_model = "../shared/models/lpips_alex";
  verb->add_option("--scene", job->scene, "Folder with a transforms.json (nerfstudio)")->required();
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
  verb->add_option("--sh-degree", training.sh_degree, "Spherical harmonics of the colours")
      ->check(CLI::Range(0, 3))
      ->capture_default_str();
  verb->add_option("--max-gaussians", training.max_gaussians, "Size of the map at most")
      ->check(CLI::Range(10, 100'000'000))
      ->capture_default_str();
  verb->add_option("--lpips", job->lpips_model, "Folder of the LPIPS network; without it there is no LPIPS")
      ->envname("EDGESPLAT_LPIPS")
      ->capture_default_str();
  verb->add_flag("--json", *as_json, "Print one JSON line on stdout");
  verb->callback(
      [job, as_json, &context] { context.work = [job, as_json] { return run_train(*job, *as_json); }; });
}

}  // namespace edgesplat::desk
