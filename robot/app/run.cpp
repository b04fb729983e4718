// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/run.hpp"

#include "common/config/config_file.hpp"
#include "common/log/log.hpp"
#include "common/sensor/rig_config.hpp"
#include "robot/app/live_input.hpp"
#include "robot/app/live_map.hpp"
#include "robot/app/map_look.hpp"
#include "robot/app/picture_log.hpp"
#include "robot/app/pipeline.hpp"
#include "robot/app/pose_log.hpp"
#include "robot/app/progress.hpp"
#include "robot/app/ptp_watch.hpp"
#include "robot/app/recording.hpp"
#include "robot/app/render_loop.hpp"
#include "robot/app/replay_input.hpp"
#include "robot/app/run_folder.hpp"
#include "robot/app/sensing_chain.hpp"

#include <cstdio>
#include <optional>
#include <string>

namespace edgesplat::app {
namespace {

Result<robot_config::RobotConfig> load_config(const Options& o) {
  config::ConfigFile file;
  if (!o.config_file.empty()) {
    EDGESPLAT_TRY(file, config::ConfigFile::load(o.config_file));
  }
  for (const std::string& assignment : o.overrides) EDGESPLAT_TRY_STATUS(file.apply_override(assignment));
  if (o.offload) EDGESPLAT_TRY_STATUS(file.apply_override("offload.setting=" + *o.offload));
  robot_config::RobotConfig config;
  EDGESPLAT_TRY_STATUS(file.read_into(config));
  if (o.threads) config.tracking.threads = *o.threads;
  if (o.server) config.server.enabled = *o.server;
  if (o.interface_name) config.server.link.interface = *o.interface_name;
  if (o.domain) config.server.link.domain = *o.domain;
  if (o.points_port) config.livox.front().points_port = static_cast<std::uint16_t>(*o.points_port);
  if (o.imu_port) config.livox.front().imu_port = static_cast<std::uint16_t>(*o.imu_port);
  if (o.frame_port) config.camera.port = static_cast<std::uint16_t>(*o.frame_port);
  return config;
}

Result<sensor::Rig> choose_rig(const std::optional<replay::BagRig>& given,
                               const std::optional<replay::ReplaySource>& recording) {
  if (recording) return recording->rig();
  if (given) return given->rig;
  return fail(Errc::kInvalidConfig,
              "a live run needs --rig FILE: which sensors there are and where they sit");
}

/// Live sensors into a sink, recorded on the way where asked for.
Status run_sensors(const Options& o, const robot_config::RobotConfig& config, const sensor::Rig& rig,
                   const Clock& clock, const LiveInput::Sink& sink, metrics::Registry& metrics,
                   const std::stop_token& stop) {
  if (!o.record.empty() && config.serial.imu)
    return fail(Errc::kInvalidConfig,
                "--record cannot keep the samples of a serial inertial sensor: run without one of the two");
  std::unique_ptr<Recording> recording;
  if (!o.record.empty()) {
    replay::RecorderConfig recorder;
    recorder.min_free_bytes = config.record.min_free_bytes;
    recorder.sync_period = from_seconds(config.record.sync_period_s);
    recorder.lidar_protocols.clear();
    for (const robot_config::LivoxSettings& lidar : config.livox)
      recorder.lidar_protocols.push_back(livox::LidarDriver::protocol_of(lidar.model));
    EDGESPLAT_TRY(recording,
                  Recording::start(o.record, config::to_toml(rig), config::to_toml(config), recorder));
  }
  std::optional<PtpWatch> ptp;
  if (config.ptp.watch) ptp.emplace(config.ptp, metrics);
  EDGESPLAT_TRY(const auto input,
                LiveInput::open(config, rig, clock, sink, recording ? recording->recorder() : nullptr));
  input->run(stop);
  input->publish_counters(metrics);
  return recording ? recording->finish(metrics) : Status();
}

/// The threaded run: live sensors or a paced recording.
Status run_threads(const Options& o, const robot_config::RobotConfig& config, const sensor::Rig& rig,
                   std::optional<replay::ReplaySource>& recording, SensingChain& chain, LiveMap& map,
                   const Clock& clock, metrics::Registry& metrics, const std::stop_token& stop) {
  PictureLog pictures(o.out.empty() ? o.out : o.out / "robot" / "frames.csv");
  std::optional<RenderLoop> render;
  if (rig.camera) {
    render.emplace(
        RenderLoopConfig{config.render.target_hz}, *rig.camera, [&map] { return map.snapshot(); }, clock,
        metrics,
        [&](const PictureTimes& picture) {
          map.on_picture(picture.took_ms);
          pictures.add(picture);
        });
  }
  Progress progress(o.json_progress, clock);
  const auto on_pose = [&](const TrackedFrame& frame) {
    progress.on_pose(frame.group);
    if (render) render->show_from(map.map_from_odom() * frame.group.odom_from_body);
  };
  const bool live = !recording.has_value();
  Pipeline pipeline(chain, live ? Backpressure::kDropOldest : Backpressure::kWait, on_pose, metrics);
  const auto push = [&](sensor::Measurement measurement) { pipeline.push(std::move(measurement)); };
  Status result;
  if (live) {
    result = run_sensors(o, config, rig, clock, push, metrics, stop);
  } else {
    ReplayInput input(*recording, o.speed, o.seconds, clock);
    result = input.run(push, stop);
  }
  pipeline.finish();
  return result;
}

/// Virtual time: every measurement is carried through all stages before the next one is read.
Status run_lockstep(const Options& o, replay::ReplaySource& recording, SensingChain& chain,
                    const std::stop_token& stop) {
  VirtualClock clock(recording.begin());
  ReplayInput input(recording, 0.0, o.seconds, clock);
  const auto carry = [&](std::vector<ReadyGroup> groups) {
    for (ReadyGroup& ready : groups) {
      if (const auto frame = chain.track(std::move(ready))) chain.keyframe(*frame);
    }
  };
  EDGESPLAT_TRY_STATUS(input.run(
      [&](sensor::Measurement measurement) {
        clock.advance_to(arrival_of(measurement));
        carry(chain.sync(std::move(measurement)));
      },
      stop));
  carry(chain.flush());
  return {};
}

void report_recording(const replay::ReplaySource& recording, metrics::Registry& metrics) {
  const replay::ReplayReport report = recording.report();
  metrics.counter("replay.measurements").add(report.measurements);
  metrics.counter("replay.bytes_skipped").add(report.bytes_skipped);
  metrics.counter("replay.packets_refused").add(report.packets_refused);
  metrics.counter("replay.frames_refused").add(report.frames_refused);
  metrics.counter("replay.points_dropped").add(report.points_dropped);
  if (!report.complete) EDGESPLAT_LOG_WARN("replay", "recording incomplete", "why", report.why);
}

Status finish(const Options& o, const robot_config::RobotConfig& config,
              const std::optional<RunFolder>& folder, const SensingChain& chain, LiveMap& map,
              metrics::Registry& metrics) {
  // As it is when the input ends: what a robot would have in its hands.
  const auto at_input_end = map.newest_snapshot();
  if (folder) EDGESPLAT_TRY_STATUS(folder->write_map_at_input_end(*at_input_end));
  if (!map.drain(from_seconds(config.server.drain_s))) {
    EDGESPLAT_LOG_WARN("map", "server did not answer everything", "waited_s", config.server.drain_s);
  }
  const auto cloud = map.newest_snapshot();
  map.publish_counters(metrics);
  chain.publish_counters(metrics);
  const RunLog& log = chain.keyframes().log();
  EDGESPLAT_LOG_INFO("robot", "run over", "poses", log.poses(), "span_s", log.span_s(), "gaussians",
                     cloud->size());
  if (!folder) return {};
  EDGESPLAT_TRY_STATUS(folder->write_results(chain.keyframes(), *cloud, map.map_from_odom()));
  EDGESPLAT_TRY_STATUS(folder->write_metrics(metrics));
  EDGESPLAT_LOG_INFO("robot", "run folder written", "path", o.out.string());
  return {};
}

}  // namespace

Status run_robot(const Options& o, const std::stop_token& stop) {
  EDGESPLAT_TRY(const robot_config::RobotConfig config, load_config(o));
  if (o.print_config) {
    std::fputs(config::to_toml(config).c_str(), stdout);
    return {};
  }
  std::optional<replay::BagRig> given_rig;
  if (!o.rig_file.empty()) {
    EDGESPLAT_TRY(given_rig, replay::load_bag_rig(o.rig_file));
  }
  std::optional<replay::ReplaySource> recording;
  if (!o.replay.empty()) {
    EDGESPLAT_TRY(recording, replay::ReplaySource::open(o.replay, given_rig));
  }
  if (o.check_config && !recording && o.rig_file.empty()) return {};
  EDGESPLAT_TRY(const sensor::Rig rig, choose_rig(given_rig, recording));
  if (o.check_config) return {};

  std::optional<RunFolder> folder;
  if (!o.out.empty()) {
    EDGESPLAT_TRY(folder, RunFolder::create(o.out, config, rig));
  }
  const SteadyClock clock;
  metrics::Registry metrics;
  EDGESPLAT_TRY(const auto map,
                LiveMap::create(config, o.lockstep, clock, folder ? folder->robot_folder() : "", metrics));
  PoseLog poses(folder ? folder->robot_folder() / "imu_rate.tum" : std::filesystem::path());
  const auto sink = [&](std::shared_ptr<const map::Keyframe> keyframe) { map->submit(std::move(keyframe)); };
  EDGESPLAT_TRY(const auto chain, SensingChain::create(config, rig, sink, clock, metrics));
  if (config.tracking.gaussian_every > 0) chain->look_at(std::make_shared<MapLook>(*map, clock, metrics));
  // In a replay arrivals are the recording's, on another clock.
  metrics::Histogram* const latency_ms = recording ? nullptr : &metrics.histogram("pose_stream.latency_ms");
  chain->stream_poses_to([&](const tracking::StreamedPose& pose, HostTime arrival) {
    if (latency_ms != nullptr) latency_ms->record(to_seconds(clock.now() - arrival) * 1e3);
    poses.add(pose);
  });
  Status run = o.lockstep ? run_lockstep(o, *recording, *chain, stop)
                          : run_threads(o, config, rig, recording, *chain, *map, clock, metrics, stop);
  if (recording) report_recording(*recording, metrics);
  // What was mapped so far is kept even when the input failed.
  EDGESPLAT_TRY_STATUS(finish(o, config, folder, *chain, *map, metrics));
  return run;
}

}  // namespace edgesplat::app
