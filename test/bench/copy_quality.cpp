// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// What the deltas' byte budget costs: the server's map and the robot's copy of it at the end of a recording,
// in virtual time (a step of the server takes STEP_MS, the link nothing), so that the figures are the same on
// every machine. usage: copy_quality RECORDING.mcap OUT STEP_MS [SERVER_KEY=VALUE...]
#include "common/config/config_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "robot/app/replay_input.hpp"
#include "robot/app/run_folder.hpp"
#include "robot/app/sensing_chain.hpp"
#include "robot/map/resident_map.hpp"
#include "server/app/mapping_stage.hpp"
#include "server/config/server_config.hpp"
#include "tools/desk/score.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>

namespace {

using namespace edgesplat;

Result<config::ServerConfig> server_config(int argc, char** argv) {
  config::ConfigFile file;
  for (int i = 4; i < argc; ++i) EDGESPLAT_TRY_STATUS(file.apply_override(argv[i]));
  config::ServerConfig server;
  EDGESPLAT_TRY_STATUS(file.read_into(server));
  return server;
}

/// The server's mapping and the robot's copy on one virtual clock.
class Copying {
 public:
  Copying(const config::ServerConfig& server, double step_ms, VirtualClock& clock)
      : clock_(clock),
        step_(from_seconds(step_ms * 1e-3)),
        stage_(
            server, {map::Epoch{1}}, [](map::RobotId) { return std::size_t{1} << 30U; }, metrics_, clock) {}

  void add(const map::Keyframe& keyframe) {
    ingest::IngestedKeyframe message;
    message.robot = map::RobotId{1};
    message.session = 1;
    message.received = clock_.now();
    message.keyframe = keyframe;
    apply(stage_.handle(message));
    ++keyframes_;
  }
  /// Steps until it is so late.
  void work_until(HostTime time) {
    for (; keyframes_ > 0 && free_at_ + step_ <= time; free_at_ += step_) {
      clock_.advance_to(free_at_ + step_);
      if (stage_.has_work()) apply(stage_.work());
    }
    if (keyframes_ == 0) free_at_ = time;
    clock_.advance_to(time);
  }
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> copy() {
    copy_.publish_if_due(clock_.now() + from_seconds(10.0));
    return copy_.snapshot();
  }
  [[nodiscard]] gaussian::GaussianCloud original() { return stage_.all_maps().front().gaussians; }
  [[nodiscard]] std::uint64_t steps() { return metrics_.counter("map.steps").value(); }
  [[nodiscard]] std::uint64_t bytes() { return metrics_.counter("map.delta_bytes").value(); }

 private:
  void apply(const std::vector<app::OutgoingDelta>& deltas) {
    for (const auto& delta : deltas) (void)copy_.apply(delta.bytes, clock_.now());
  }

  VirtualClock& clock_;
  const nanoseconds step_;
  metrics::Registry metrics_;
  app::MappingStage stage_;
  map::ResidentMap copy_{{}};
  int keyframes_ = 0;
  HostTime free_at_{};  ///< the server has done its last step
};

Result<nlohmann::json> score(const app::RunFolder& folder, const char* recording,
                             const std::filesystem::path& out, const gaussian::GaussianCloud& cloud) {
  EDGESPLAT_TRY_STATUS(folder.write_map_at_input_end(cloud));
  desk::ScoreOptions scoring;
  scoring.run = out;
  scoring.input = recording;
  return desk::score_run(scoring);
}

Status run(int argc, char** argv) {
  const std::filesystem::path out = argv[2];
  EDGESPLAT_TRY(const config::ServerConfig server, server_config(argc, argv));
  EDGESPLAT_TRY(replay::ReplaySource recording, replay::ReplaySource::open(argv[1]));
  const sensor::Rig rig = recording.rig();
  const robot_config::RobotConfig robot;
  EDGESPLAT_TRY(const app::RunFolder folder, app::RunFolder::create(out, robot, rig));
  metrics::Registry metrics;
  VirtualClock clock(recording.begin());
  Copying copying(server, std::atof(argv[3]), clock);
  const auto sink = [&](const std::shared_ptr<const map::Keyframe>& keyframe) { copying.add(*keyframe); };
  EDGESPLAT_TRY(const auto chain, app::SensingChain::create(robot, rig, sink, clock, metrics));
  app::ReplayInput input(recording, 0.0, 0.0, clock);
  EDGESPLAT_TRY_STATUS(input.run(
      [&](sensor::Measurement measurement) {
        copying.work_until(sensor::arrival_of(measurement));
        for (app::ReadyGroup& ready : chain->sync(std::move(measurement))) {
          if (const auto frame = chain->track(std::move(ready))) chain->keyframe(*frame);
        }
      },
      {}));
  const auto copy = copying.copy();
  const gaussian::GaussianCloud original = copying.original();
  EDGESPLAT_TRY_STATUS(folder.write_results(chain->keyframes(), *copy, {}));
  EDGESPLAT_TRY(const nlohmann::json of_original, score(folder, argv[1], out, original));
  EDGESPLAT_TRY(const nlohmann::json of_copy, score(folder, argv[1], out, *copy));
  std::printf(
      "%llu steps, %.2f MB of deltas: server's map %zu Gaussians, %.2f dB; robot's copy %zu, %.2f dB\n",
      static_cast<unsigned long long>(copying.steps()), static_cast<double>(copying.bytes()) * 1e-6,
      original.size(), of_original["psnr_db"].get<double>(), copy->size(), of_copy["psnr_db"].get<double>());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: copy_quality RECORDING.mcap OUT STEP_MS [SERVER_KEY=VALUE...]\n");
    return 2;
  }
  const Status status = run(argc, argv);
  if (status) return 0;
  std::fprintf(stderr, "copy_quality: %s\n", status.error().context.c_str());
  return 1;
}
