// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"
#include "tools/desk/verbs.hpp"
#include "tools/virtual_device/lidar_fault.hpp"
#include "tools/virtual_device/stream.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::desk {
namespace {

struct StreamVerbOptions {
  virtual_device::StreamOptions stream;
  std::vector<std::string> lidars = {"raw"};
  // One for each of several LiDARs, or one for all where that makes sense.
  std::vector<std::string> lidar_addresses = {"127.0.0.1"};
  std::vector<std::string> lidar_serials = {"47MVIRTUAL0001"};
  std::vector<double> lidar_drifts_ppm;
  std::string lidar_sync = "ptp";
  std::vector<std::string> lidar_faults;
  virtual_device::LidarDeviceConfig device;
  bool json = false;
};

/// "1:silence@3+2" happens to the second LiDAR, without a number to the first.
Result<std::pair<std::size_t, virtual_device::LidarFault>> parse_fault_of(const std::string& text,
                                                                          std::size_t lidars) {
  std::size_t unit = 0;
  std::string fault = text;
  if (text.size() > 2 && text[1] == ':' && text[0] >= '0' && text[0] <= '9') {
    unit = static_cast<std::size_t>(text[0] - '0');
    fault = text.substr(2);
  }
  if (unit >= lidars)
    return fail(Errc::kInvalidConfig, "--lidar-fault " + text + ": there are " + std::to_string(lidars) +
                                          " LiDARs, counted from 0");
  EDGESPLAT_TRY(auto parsed, virtual_device::parse_lidar_fault(fault));
  return std::pair{unit, parsed};
}

/// The virtual LiDARs that were asked for; none for bare datagrams.
Result<std::vector<virtual_device::LidarDeviceConfig>> lidar_devices(const StreamVerbOptions& options) {
  std::vector<virtual_device::LidarDeviceConfig> devices;
  const std::size_t count = options.lidars.size();
  if (count == 1 && options.lidars.front() == "raw") return devices;
  if (options.lidar_addresses.size() != count || options.lidar_serials.size() != count)
    return fail(Errc::kInvalidConfig, "--lidar names " + std::to_string(count) +
                                          ": --lidar-address and --lidar-serial must name as many");
  for (std::size_t unit = 0; unit < count; ++unit) {
    if (options.lidars[unit] == "raw") return fail(Errc::kInvalidConfig, "--lidar raw stands alone");
    virtual_device::LidarDeviceConfig device = options.device;
    device.model = options.lidars[unit] == "avia" ? virtual_device::LidarModel::kAvia
                                                  : virtual_device::LidarModel::kMid360;
    device.seed = device.unit.clock.seed = options.stream.seed + unit;
    using virtual_device::UnitSync;
    device.unit.clock.sync = options.lidar_sync == "ptp"   ? UnitSync::kPtp
                             : options.lidar_sync == "gps" ? UnitSync::kPulse
                                                           : UnitSync::kNone;
    device.unit.serial_number = options.lidar_serials[unit];
    if (!options.lidar_drifts_ppm.empty())
      device.unit.clock.drift_ppm =
          options.lidar_drifts_ppm[std::min(unit, options.lidar_drifts_ppm.size() - 1)];
    EDGESPLAT_TRY(device.unit.ip, virtual_device::parse_address(options.lidar_addresses[unit]));
    devices.push_back(std::move(device));
  }
  for (const std::string& text : options.lidar_faults) {
    EDGESPLAT_TRY(const auto fault, parse_fault_of(text, count));
    devices[fault.first].faults.push_back(fault.second);
  }
  return devices;
}

nlohmann::json lidar_json(const virtual_device::LidarDeviceCounters& lidar) {
  return {{"points_sent", lidar.points_sent},
          {"imu_sent", lidar.imu_sent},
          {"unsent", lidar.unsent},
          {"faults", lidar.faults},
          {"requests", lidar.unit.requests},
          {"bad_frames", lidar.unit.bad_frames},
          {"refused", lidar.unit.refused},
          {"written", lidar.unit.written},
          {"sessions", lidar.unit.sessions},
          {"seconds_told", lidar.unit.seconds_told},
          {"seconds_late", lidar.unit.seconds_late}};
}

nlohmann::json to_json(const virtual_device::StreamReport& report) {
  nlohmann::json lidars = nlohmann::json::array();
  for (const auto& lidar : report.lidars) lidars.push_back(lidar_json(lidar));
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
          {"lidar_asked", report.lidar_asked},
          {"lidar", lidars.empty() ? nlohmann::json() : lidars.front()},
          {"lidars", lidars},
          {"recording_problem", report.recording_problem}};
}

Status run_stream(const StreamVerbOptions& options) {
  const thread::StopSignal stop;
  virtual_device::StreamOptions stream = options.stream;
  EDGESPLAT_TRY(stream.lidars, lidar_devices(options));
  EDGESPLAT_TRY(const auto report, virtual_device::stream_recording(stream, stop.token()));
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

void add_lidar_options(CLI::App& verb, StreamVerbOptions& options) {
  auto& unit = options.device.unit;
  verb.add_option(
          "--lidar", options.lidars,
          "raw = datagrams as recorded to --points-port and --imu-port; mid360, avia = a virtual LiDAR that "
          "the robot has to find and to start, with a clock of its own; several with commas between, one for "
          "each of the recording's")
      ->delimiter(',')
      ->check(CLI::IsMember({"raw", "mid360", "avia"}))
      ->capture_default_str();
  verb.add_option("--lidar-address", options.lidar_addresses,
                  "Its IPv4 address, one of this machine's; for several with commas between")
      ->delimiter(',')
      ->capture_default_str();
  verb.add_option("--lidar-serial", options.lidar_serials,
                  "Its serial number, 14 characters; for several with commas between")
      ->delimiter(',')
      ->capture_default_str();
  verb.add_option("--lidar-sync", options.lidar_sync, "What disciplines its clock")
      ->check(CLI::IsMember({"none", "ptp", "gps"}))
      ->capture_default_str();
  verb.add_option("--lidar-drift-ppm", options.lidar_drifts_ppm,
                  "Of its crystal, 30 where not said; for several with commas between")
      ->delimiter(',')
      ->check(CLI::Range(-1000.0, 1000.0));
  verb.add_option("--lidar-servo-s", unit.clock.servo_sigma_s, "Deviation of its clock's servo")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option(
          "--lidar-fault", options.lidar_faults,
          "silence@T+S, reboot@T+S, address@T+S=IP, loss@T+S=SHARE, stuck-sync@T, clock-step@T=S (T, S in "
          "seconds); 1:silence@T+S happens to the second of several; may be repeated")
      ->allow_extra_args(false);
  verb.add_option("--wait-for-lidar", options.stream.wait_for_lidar_s,
                  "Seconds to wait for the robot to start a virtual LiDAR")
      ->capture_default_str();
}

}  // namespace

void add_stream_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("stream", "Play a recording as the devices: UDP datagrams and a camera");
  auto options = std::make_shared<StreamVerbOptions>();
  auto& stream = options->stream;
  options->device.unit.clock.servo_sigma_s = 1e-6;  // beside the noise that the recording's stamps have
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
  add_lidar_options(*verb, *options);
  verb->add_flag("--json", options->json, "The result as one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_stream(*options); }; });
}

}  // namespace edgesplat::desk
