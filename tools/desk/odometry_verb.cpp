// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"
#include "common/io/atomic_file.hpp"
#include "common/metrics/process_usage.hpp"
#include "robot/tracking/health_csv.hpp"
#include "tools/accuracy/evaluation_text.hpp"
#include "tools/desk/odometry.hpp"
#include "tools/desk/processor_clock.hpp"
#include "tools/desk/verbs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>
#include <string>

namespace edgesplat::desk {
namespace {

struct OdometryOptions {
  std::string lidar;
  std::string imu;
  std::string rig;
  std::string out;
  std::string groups;
  std::vector<std::string> settings;
  OdometryMode mode = OdometryMode::kLidarInertialVisual;
  ScanTiming timing = ScanTiming::kInstant;
  double from_s = 0.0;
  bool json = false;
};

Result<OdometryJob> job_of(const OdometryOptions& options) {
  OdometryJob job;
  job.lidar = options.lidar;
  job.timing = options.timing;
  job.mode = options.mode;
  job.from_s = options.from_s;
  if (!options.imu.empty()) job.imu = options.imu;
  if (!options.rig.empty()) {
    EDGESPLAT_TRY(job.rig, replay::load_bag_rig(options.rig));
  }
  job.tracking = default_tracking(job.lidar, job.rig);
  config::ConfigFile settings;
  for (const std::string& assignment : options.settings) {
    EDGESPLAT_TRY_STATUS(settings.apply_override(assignment));
  }
  EDGESPLAT_TRY_STATUS(settings.read_into(job.tracking));
  return job;
}

nlohmann::json quantiles(std::vector<double> values) {
  if (values.empty()) values.push_back(0.0);
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {{"mean", sum / static_cast<double>(values.size())},
          {"p50", quantile(0.5)},
          {"p95", quantile(0.95)},
          {"max", quantile(1.0)}};
}

nlohmann::json summary_of(const OdometryRun& run) {
  double path_m = 0.0;
  for (std::size_t i = 1; i < run.poses.size(); ++i) {
    path_m +=
        (run.poses[i].world_from_body.translation_m - run.poses[i - 1].world_from_body.translation_m).norm();
  }
  const metrics::ProcessUsage usage = metrics::process_usage();
  return {{"groups", run.groups},
          {"poses", run.poses.size()},
          {"coasted_groups", run.coasted_groups},
          {"path_m", path_m},
          {"track_ms", quantiles(run.track_ms)},
          {"track_cpu_ms", quantiles(run.track_cpu_ms)},
          {"map_bytes", run.map_bytes},
          {"cpu_s", usage.cpu_s},
          {"peak_rss_bytes", usage.peak_rss_bytes}};
}

/// Against the truth in a simulated recording; nothing where there is none.
std::optional<accuracy::Evaluation> evaluate(const OdometryJob& job, const OdometryRun& run) {
  if (job.lidar.extension() != ".mcap") return std::nullopt;
  const auto truth = accuracy::read_recorded_truth(job.lidar);
  if (!truth) return std::nullopt;
  constexpr auto kMaxGap = from_seconds(0.1);
  const auto evaluation = accuracy::evaluate(accuracy::associate_interpolated(run.poses, *truth, kMaxGap));
  if (!evaluation) return std::nullopt;
  return *evaluation;
}

Status write_groups(const std::string& path, const OdometryRun& run) {
  std::string csv = fmt::format("stamp_s,{},track_ms\n", tracking::health_csv_header());
  for (std::size_t i = 0; i < run.health.size(); ++i) {
    const std::int64_t ns = to_ns(run.health[i].stamp);
    csv += fmt::format("{}.{:09},{},{:.3f}\n", ns / 1'000'000'000, ns % 1'000'000'000,
                       tracking::health_csv(run.health[i].health), run.track_ms[i]);
  }
  return io::write_file_atomically(path, std::as_bytes(std::span(csv.data(), csv.size())));
}

Status run_verb(const OdometryOptions& options) {
  EDGESPLAT_TRY(const OdometryJob job, job_of(options));
  const SteadyClock clock;
  EDGESPLAT_TRY(const OdometryRun run, run_odometry(job, clock, ProcessorClock(1)));
  EDGESPLAT_TRY_STATUS(io::write_tum(options.out, run.poses));
  if (!options.groups.empty()) EDGESPLAT_TRY_STATUS(write_groups(options.groups, run));
  nlohmann::json summary = summary_of(run);
  const auto evaluation = evaluate(job, run);
  summary["accuracy"] = evaluation ? accuracy::to_json(*evaluation) : nlohmann::json();
  if (options.json) {
    std::fputs((summary.dump() + "\n").c_str(), stdout);
    return {};
  }
  const std::string words = fmt::format(
      "{} groups, {} poses, {} coasted; {:.2f} m; {:.1f} ms a group (95 %: {:.1f}, most: {:.1f}); "
      "CPU {:.1f} s, memory {:.0f} MB at most; wrote {}\n",
      run.groups, run.poses.size(), run.coasted_groups, summary["path_m"].get<double>(),
      summary["track_ms"]["p50"].get<double>(), summary["track_ms"]["p95"].get<double>(),
      summary["track_ms"]["max"].get<double>(), summary["cpu_s"].get<double>(),
      summary["peak_rss_bytes"].get<double>() * 1e-6, options.out);
  std::fputs(words.c_str(), stderr);
  if (evaluation) std::fputs(accuracy::to_text(*evaluation).c_str(), stderr);
  return {};
}

}  // namespace

void add_odometry_verb(CLI::App& app, VerbContext& context) {
  auto* verb =
      app.add_subcommand("odometry", "Track a folder of LiDAR scans or a recording, without a server");
  auto options = std::make_shared<OdometryOptions>();
  verb->add_option(
          "--lidar,--bag", options->lidar,
          "Folder of KITTI .bin scans (times.txt or 10 Hz), or a recording: our .mcap, or with --rig one "
          "of ROS (.bag, .mcap, .db3)")
      ->required();
  verb->add_option("--imu", options->imu,
                   "IMU samples, CSV: t_ns, gyro x y z (rad/s), accelerometer x y z (m/s^2)");
  verb->add_option("--rig", options->rig,
                   "rig.toml with the LiDAR's noise and place, instead of the recording's");
  verb->add_option("--out", options->out, "Trajectory to write, TUM format")->required();
  verb->add_option(
          "--timing", options->timing,
          "When the rays of scans without times were fired: instant (default: all at the stamp, as KISS-ICP "
          "and small_gicp take them), azimuth: in one turn around it (HDL-64E), or auto: azimuth for KITTI's "
          "raw scans, whose points then fit better")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, ScanTiming>{{"auto", ScanTiming::kAuto},
                                                                    {"instant", ScanTiming::kInstant},
                                                                    {"azimuth", ScanTiming::kAzimuth}}));
  verb->add_option("--mode", options->mode,
                   "Which sensors the pose comes from: livo (LiDAR, IMU and camera, default), lio, lo")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, OdometryMode>{{"livo", OdometryMode::kLidarInertialVisual},
                                              {"lio", OdometryMode::kLidarInertial},
                                              {"lo", OdometryMode::kLidar}}));
  verb->add_option("--from", options->from_s, "Leave out the first so many seconds")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--groups", options->groups,
                   "CSV to write, one line a group: how far its pose can be trusted");
  verb->add_option("--set", options->settings, "A tracking setting, e.g. root_voxel_m=1 (repeatable)");
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_verb(*options); }; });
}

}  // namespace edgesplat::desk
