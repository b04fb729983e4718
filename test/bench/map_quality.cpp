// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// What a number of optimisation steps a keyframe makes of a map, without clocks and links: the same figures
// on every machine. usage: map_quality RECORDING OUT STEPS_PER_KEYFRAME [SERVER_KEY=VALUE |
// robot:KEY=VALUE]...
#include "common/config/config_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "robot/app/replay_input.hpp"
#include "robot/app/run_folder.hpp"
#include "robot/app/sensing_chain.hpp"
#include "server/config/server_config.hpp"
#include "server/optimise/map_builder.hpp"
#include "tools/desk/score.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace edgesplat;

struct Settings {
  config::ServerConfig server;
  robot_config::RobotConfig robot;
};

Result<Settings> read_settings(int argc, char** argv) {
  constexpr std::string_view kRobot = "robot:";
  config::ConfigFile server, robot;
  for (int i = 4; i < argc; ++i) {
    const std::string_view setting = argv[i];
    EDGESPLAT_TRY_STATUS(setting.starts_with(kRobot) ? robot.apply_override(setting.substr(kRobot.size()))
                                                     : server.apply_override(setting));
  }
  Settings settings;
  EDGESPLAT_TRY_STATUS(server.read_into(settings.server));
  EDGESPLAT_TRY_STATUS(robot.read_into(settings.robot));
  settings.server.optimise.engine.keep_seeds = true;
  return settings;
}

Status run(int argc, char** argv) {
  const std::filesystem::path out = argv[2];
  const int steps_per_keyframe = std::atoi(argv[3]);
  EDGESPLAT_TRY(const Settings settings, read_settings(argc, argv));
  const auto& [server, robot] = settings;
  EDGESPLAT_TRY(replay::ReplaySource recording, replay::ReplaySource::open(argv[1]));
  const sensor::Rig rig = recording.rig();
  EDGESPLAT_TRY(const app::RunFolder folder, app::RunFolder::create(out, robot, rig));
  const SteadyClock clock;
  metrics::Registry metrics;
  mapping::IdAllocator ids(server.instance_id);
  EDGESPLAT_TRY(const auto builder, optimise::MapBuilder::create(server.optimise.engine, ids, clock));

  std::chrono::nanoseconds in_steps{};
  std::uint64_t steps = 0;
  const auto sink = [&](const std::shared_ptr<const map::Keyframe>& keyframe) {
    builder->add(*keyframe);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps_per_keyframe && builder->step(); ++i) ++steps;
    in_steps += std::chrono::steady_clock::now() - start;
  };
  EDGESPLAT_TRY(const auto chain, app::SensingChain::create(robot, rig, sink, clock, metrics));
  app::ReplayInput input(recording, 0.0, 0.0, clock);
  EDGESPLAT_TRY_STATUS(input.run(
      [&](sensor::Measurement measurement) {
        for (app::ReadyGroup& ready : chain->sync(std::move(measurement))) {
          if (const auto frame = chain->track(std::move(ready))) chain->keyframe(*frame);
        }
      },
      {}));
  const gaussian::GaussianCloud& cloud = builder->engine().cloud();
  EDGESPLAT_TRY_STATUS(folder.write_results(chain->keyframes(), cloud, {}));
  EDGESPLAT_TRY_STATUS(folder.write_map_at_input_end(cloud));
  std::filesystem::create_directories(out / "server");
  EDGESPLAT_TRY_STATUS(io::write_gaussians_ply(out / "server" / "seeded.ply", builder->engine().seeds()));
  desk::ScoreOptions scoring;
  scoring.run = out;
  if (!std::filesystem::is_directory(argv[1])) scoring.input = argv[1];
  EDGESPLAT_TRY(const nlohmann::json scores, desk::score_run(scoring));
  std::printf(
      "%llu steps, %.1f ms each, %zu Gaussians (%zu seeded, %llu gone): PSNR %.2f dB, SSIM %.3f, seeded %.2f "
      "dB, "
      "nearest %.2f dB\n",
      static_cast<unsigned long long>(steps),
      std::chrono::duration<double, std::milli>(in_steps).count() /
          static_cast<double>(std::max<std::uint64_t>(steps, 1)),
      cloud.size(), builder->engine().seeds().size(),
      static_cast<unsigned long long>(builder->engine().gone()), scores["psnr_db"].get<double>(),
      scores["ssim"].get<double>(), scores["psnr_seeded_db"].get<double>(),
      scores["psnr_nearest_db"].get<double>());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(
        stderr,
        "usage: map_quality RECORDING OUT STEPS_PER_KEYFRAME [SERVER_KEY=VALUE | robot:KEY=VALUE]...\n");
    return 2;
  }
  const Status status = run(argc, argv);
  if (status) return 0;
  std::fprintf(stderr, "map_quality: %s\n", status.error().context.c_str());
  return 1;
}
