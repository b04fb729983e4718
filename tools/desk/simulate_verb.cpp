// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"
#include "tools/desk/verbs.hpp"
#include "tools/simulate/simulator.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace edgesplat::desk {
namespace {

struct SimulateVerbOptions {
  simulate::SimulateOptions simulation;
  std::vector<simulate::LidarKind> lidars = {simulate::LidarKind::kMid360};
  std::string camera = "320x256";
  double spin_deg_per_s = 0.0;
  std::string clean_poses;
  std::string clean_folder;
  bool progress = false;
  bool json = false;
};

// One line a second: on stderr for people, on stdout for programs.
class ProgressLine {
 public:
  ProgressLine(double total_s, bool for_people, bool for_programs)
      : total_s_(total_s), for_people_(for_people), for_programs_(for_programs) {}

  void show(double simulated_s) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(1) && simulated_s < total_s_) return;
    last_ = now;
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    if (for_people_) {
      std::fprintf(stderr, "simulated %.1f of %.1f s in %.0f s\n", simulated_s, total_s_, elapsed_s);
    }
    if (for_programs_) {
      const nlohmann::json line = {{"event", "progress"},
                                   {"simulated_s", simulated_s},
                                   {"total_s", total_s_},
                                   {"elapsed_s", elapsed_s}};
      std::printf("%s\n", line.dump().c_str());
      std::fflush(stdout);
    }
  }

 private:
  double total_s_;
  bool for_people_;
  bool for_programs_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_;
};

Status parse_camera(const std::string& text, simulate::SimulateOptions& simulation) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &simulation.camera_width_px, &simulation.camera_height_px,
                  &rest) != 2) {
    return fail(Errc::kInvalidConfig, "--camera '" + text + "' is not of the form 320x256");
  }
  return {};
}

void print_report(const simulate::SimulateReport& report, const SimulateVerbOptions& options) {
  if (options.json) {
    const nlohmann::json line = {{"event", "done"},
                                 {"recording", options.simulation.out.string()},
                                 {"point_packets", report.point_packets},
                                 {"imu_packets", report.imu_packets},
                                 {"frames", report.frames},
                                 {"bytes", report.bytes},
                                 {"driven_m", report.driven_m},
                                 {"stopped", report.stopped}};
    std::printf("%s\n", line.dump().c_str());
    return;
  }
  std::fprintf(stderr, "%s: %llu point packets, %llu IMU packets, %llu frames, %.1f MB, %.1f m driven%s\n",
               options.simulation.out.c_str(), static_cast<unsigned long long>(report.point_packets),
               static_cast<unsigned long long>(report.imu_packets),
               static_cast<unsigned long long>(report.frames), 1e-6 * static_cast<double>(report.bytes),
               report.driven_m, report.stopped ? " (stopped early)" : "");
}

Status run_simulate(SimulateVerbOptions options) {
  EDGESPLAT_TRY_STATUS(parse_camera(options.camera, options.simulation));
  options.simulation.lidar = options.lidars.front();
  options.simulation.more_lidars.assign(options.lidars.begin() + 1, options.lidars.end());
  options.simulation.spin_radps = options.spin_deg_per_s * std::numbers::pi / 180.0;
  if (options.clean_poses.empty() != options.clean_folder.empty()) {
    return fail(Errc::kInvalidConfig, "--clean-views and --clean-out go together");
  }
  if (!options.clean_poses.empty()) {
    options.simulation.clean_views = simulate::CleanViews{options.clean_poses, options.clean_folder};
  } else if (options.simulation.out.empty()) {
    return fail(Errc::kInvalidConfig, "nothing to do: give --out FILE.mcap or --clean-views");
  }
  const thread::StopSignal stop;
  ProgressLine line(options.simulation.seconds, options.progress || ::isatty(STDERR_FILENO) != 0,
                    options.json);
  EDGESPLAT_TRY(const auto report,
                simulate::simulate(
                    options.simulation, [&line](double s) { line.show(s); }, stop.token()));
  if (!options.simulation.out.empty()) print_report(report, options);
  return {};
}

}  // namespace

void add_simulate_verb(CLI::App& app, VerbContext& context) {
  using simulate::ClockMode;
  using simulate::LidarKind;
  using simulate::Lighting;
  auto* verb =
      app.add_subcommand("simulate", "Simulate a robot in a world and write what its sensors measure");
  auto options = std::make_shared<SimulateVerbOptions>();
  auto& simulation = options->simulation;
  verb->add_option("--world", simulation.world.name,
                   "corridor, bare (without texture), loop (300 m), stairs, street, tunnel or square")
      ->capture_default_str();
  verb->add_option("--seconds", simulation.seconds, "Length of the recording")->capture_default_str();
  verb->add_option("--pedestrians", simulation.world.pedestrians, "Walking people, 0..100")
      ->capture_default_str();
  verb->add_option("--cars", simulation.world.cars, "Moving cars (street only), 0..50")
      ->capture_default_str();
  verb->add_option("--seed", simulation.world.seed, "Decides every texture, gait and noise")
      ->capture_default_str();
  verb->add_option("--out", simulation.out, "The recording to write, .mcap");
  verb->add_option("--lidar", options->lidars, "mid360 or avia; several with commas between: mid360,avia")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, LidarKind>{{"mid360", LidarKind::kMid360}, {"avia", LidarKind::kAvia}}));
  verb->add_option("--clock", simulation.clock, "Devices' clocks: ptp (disciplined) or free")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, ClockMode>{{"ptp", ClockMode::kPtp}, {"free", ClockMode::kFree}}));
  verb->add_option("--camera", options->camera, "Size of the picture, WxH; 0x0 = no camera")
      ->capture_default_str();
  verb->add_option("--camera-stamp-delay", simulation.camera_stamp_delay_s,
                   "The camera's stamps come this many s before mid-exposure");
  verb->add_option("--body-motion", simulation.body_motion, "Scale of sway and bumps, 0 = on rails");
  verb->add_option("--spin", options->spin_deg_per_s,
                   "It turns on itself while it drives, deg/s, one way and the other");
  verb->add_option("--lighting", simulation.lighting,
                   "steady, or failing: the exposure in leaps, the light out for 3 s in every 10")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Lighting>{{"steady", Lighting::kSteady}, {"failing", Lighting::kFailing}}));
  verb->add_option("--clean-views", options->clean_poses,
                   "TUM file of body poses to take clean pictures from");
  verb->add_option("--clean-out", options->clean_folder, "Folder for the clean pictures");
  verb->add_flag("--progress", options->progress, "A line a second on stderr even where that is no terminal");
  verb->add_flag("--json", options->json, "Progress and result as JSON lines on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_simulate(*options); }; });
}

}  // namespace edgesplat::desk
