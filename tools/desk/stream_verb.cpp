// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"
#include "tools/desk/verbs.hpp"
#include "tools/virtual_device/stream.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <map>
#include <memory>
#include <string>

namespace edgesplat::desk {
namespace {

struct StreamVerbOptions {
  virtual_device::StreamOptions stream;
  bool json = false;
};

nlohmann::json to_json(const virtual_device::StreamReport& report) {
  return {{"event", "done"},
          {"points_sent", report.points_sent},
          {"imu_sent", report.imu_sent},
          {"refused", report.refused},
          {"flipped", report.flipped},
          {"dropped", report.dropped},
          {"frames_sent", report.frames_sent},
          {"frames_lost", report.frames_lost},
          {"camera_packets", report.camera_packets},
          {"camera_packets_lost", report.camera_packets_lost},
          {"camera_packets_resent", report.camera_packets_resent},
          {"messages_skipped", report.messages_skipped},
          {"late", report.late},
          {"most_late_ms", 1e3 * to_seconds(report.most_late)},
          {"camera_connected", report.camera_connected},
          {"stopped", report.stopped},
          {"recording_problem", report.recording_problem}};
}

Status run_stream(const StreamVerbOptions& options) {
  const thread::StopSignal stop;
  EDGESPLAT_TRY(const auto report, virtual_device::stream_recording(options.stream, stop.token()));
  const nlohmann::json figures = to_json(report);
  if (options.json) {
    std::printf("%s\n", figures.dump().c_str());
    return {};
  }
  for (const auto& [name, value] : figures.items()) {
    if (name != "event") std::fprintf(stderr, "%-18s %s\n", name.c_str(), value.dump().c_str());
  }
  return {};
}

}  // namespace

void add_stream_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("stream", "Play a recording as the devices: UDP datagrams and a camera");
  auto options = std::make_shared<StreamVerbOptions>();
  auto& stream = options->stream;
  verb->add_option("recording", stream.recording, "The .mcap to play")->required();
  verb->add_option("--to", stream.to, "IPv4 address of the robot")->capture_default_str();
  verb->add_option("--points-port", stream.points_port, "UDP port for points")->capture_default_str();
  verb->add_option("--imu-port", stream.imu_port, "UDP port for the IMU")->capture_default_str();
  verb->add_option("--frame-port", stream.frame_port, "TCP port on which frames are served")
      ->capture_default_str();
  verb->add_option("--camera", stream.camera, "socket = frames over TCP, gige = a GigE Vision camera")
      ->transform(CLI::CheckedTransformer(std::map<std::string, virtual_device::CameraKind>{
          {"socket", virtual_device::CameraKind::kFrameSocket},
          {"gige", virtual_device::CameraKind::kGige}}));
  verb->add_option("--camera-address", stream.gige.address, "IPv4 address of this host for the GigE camera")
      ->capture_default_str();
  verb->add_option("--camera-path-bytes", stream.gige.path_bytes,
                   "Largest packet that gets through, 256..9000")
      ->capture_default_str();
  verb->add_option("--camera-loss", stream.gige_loss, "Share of the GigE camera's packets lost, 0..1");
  verb->add_option("--speed", stream.speed, "2 = twice as fast")->capture_default_str();
  verb->add_option("--wait-for-camera", stream.wait_for_camera_s, "Seconds to wait for the robot to connect")
      ->capture_default_str();
  verb->add_option("--flip-bits", stream.faults.flip, "Share of datagrams with one bit flipped, 0..1");
  verb->add_option("--drop", stream.faults.drop, "Share of datagrams lost, 0..1");
  verb->add_option("--seed", stream.seed, "Of the faults")->capture_default_str();
  verb->add_flag("--json", options->json, "The result as one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_stream(*options); }; });
}

}  // namespace edgesplat::desk
