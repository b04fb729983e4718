// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/config/robot_config.hpp"

#include "common/config/config_reader.hpp"

namespace edgesplat::robot_config {
namespace {

using config::ConfigReader;
using config::Range;

void describe_livox(ConfigReader& reader, LivoxSettings& c) {
  reader.choice("model", c.model,
                {{"listen", livox::LidarChoice::kListen},
                 {"mid360", livox::LidarChoice::kMid360},
                 {"avia", livox::LidarChoice::kAvia}},
                "found, started and kept; listen = takes what comes and commands nothing");
  reader.field("serial", c.serial, "serial number of the LiDAR to use; empty = the first that answers");
  reader.field("address", c.address,
               "where it is, and data from elsewhere are dropped; empty = searched for");
  reader.choice("returns", c.returns,
                {{"first", livox::ReturnMode::kFirst},
                 {"strongest", livox::ReturnMode::kStrongest},
                 {"dual", livox::ReturnMode::kDual},
                 {"triple", livox::ReturnMode::kTriple}},
                "of each shot of an Avia");
  reader.field("pulse_per_second", c.pulse_per_second,
               "a pulse a second reaches it: it is told which; see [pps]");
  reader.field("bind_address", c.bind_address, "address of the interface the LiDAR is on; 0.0.0.0 = all");
  reader.field("points_port", c.points_port, {1, 65535}, "UDP port the points arrive at");
  reader.field("imu_port", c.imu_port, {1, 65535}, "UDP port the IMU samples arrive at");
  reader.field("control_port", c.control_port, {0, 65535}, "UDP port it is commanded from; 0 = any");
  reader.field("push_port", c.push_port, {0, 65535}, "UDP port a Mid-360 reports its state to; 0 = any");
}

/// What goes wrong between two LiDARs on one network.
void check_livox(ConfigReader& reader, const std::vector<LivoxSettings>& all) {
  const auto name = [](std::size_t unit) { return "[[livox]] " + std::to_string(unit); };
  const auto clash = [](std::uint16_t a, std::uint16_t b) { return a == b && a != 0; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const LivoxSettings& a = all[i];
    if (all.size() > 1 && a.model != livox::LidarChoice::kListen && a.serial.empty() && a.address.empty())
      reader.problem("livox", name(i) + " needs a serial number or an address: there are several");
    for (std::size_t j = 0; j < i; ++j) {
      const LivoxSettings& b = all[j];
      const std::string both = name(j) + " and " + std::to_string(i);
      if (!a.serial.empty() && a.serial == b.serial) reader.problem("livox", both + " have the same serial");
      if (!a.address.empty() && a.address == b.address)
        reader.problem("livox", both + " have the same address");
      const bool apart =
          a.bind_address != b.bind_address && a.bind_address != "0.0.0.0" && b.bind_address != "0.0.0.0";
      const std::uint16_t a_ports[] = {a.points_port, a.imu_port, a.control_port, a.push_port};
      const std::uint16_t b_ports[] = {b.points_port, b.imu_port, b.control_port, b.push_port};
      for (const std::uint16_t one : a_ports)
        for (const std::uint16_t other : b_ports)
          if (!apart && clash(one, other))
            reader.problem("livox",
                           both + " both use UDP port " + std::to_string(one) + ": give each its own");
    }
  }
}

void describe_camera(ConfigReader& reader, CameraSettings& c) {
  reader.choice("source", c.source,
                {{"frame_socket", CameraSource::kFrameSocket}, {"gige", CameraSource::kGige}},
                "frame_socket = pictures over TCP, gige = a GigE Vision camera");
  reader.field("host", c.host, "address of the frame socket's camera");
  reader.field("port", c.port, {1, 65535}, "and its TCP port");
  reader.table("gige", "the GigE Vision camera", [&] { describe(reader, c.gige); });
}

void describe_serial(ConfigReader& reader, SerialSettings& c) {
  reader.field("imu", c.imu, "inertial samples from this line instead of the LiDAR's");
  reader.field("trigger", c.trigger, "trigger pulses from this line stamp a camera whose clock is free");
  reader.field("trigger_period_s", c.trigger_period_s, Range{0.001, 10.0}, "between two pulses");
  reader.field("path", c.port.path, "the serial device");
  reader.field("baud", c.port.baud, {9600, 1000000}, "a rate that serial lines have");
  reader.field("silence_s", c.port.silence_s, Range{0.05, 60.0}, "no byte this long: opened anew");
}

void describe_pps(ConfigReader& reader, PpsSettings& c) {
  reader.field(
      "device", c.device,
      "where the LiDAR's pulse is captured too, as /dev/pps0; empty = it comes at full seconds of this "
      "machine's clock");
  reader.field(
      "on_seconds", c.on_seconds,
      "it begins full seconds of UTC, as a GPS receiver's; false = anywhere, as a microcontroller's");
}

void describe_ptp(ConfigReader& reader, PtpSettings& c) {
  reader.field("watch", c.watch, "ask ptp4l of this machine how PTP is");
  reader.field("program", c.program, "linuxptp's pmc");
  reader.field("period_s", c.period_s, Range{0.1, 600.0}, "between two questions");
  reader.field("offset_limit_us", c.offset_limit_us, Range{0.1, 1e6},
               "from the master, where this machine is a slave");
}

void describe_sync(ConfigReader& reader, sync::GroupBuilderConfig& c) {
  reader.field("period_s", c.period_s, Range{0.01, 1.0}, "cut this often where no image tells when");
  reader.field("image_gap_s", c.image_gap_s, Range{0.05, 5.0},
               "images further apart: periodic cuts in between");
  reader.field("image_wait_s", c.image_wait_s, Range{0.0, 1.0}, "how far an image may lag behind the points");
  reader.field("sensor_gap_s", c.sensor_gap_s, Range{0.05, 5.0},
               "LiDAR or IMU silent this long: go on without");
  reader.field("image_tolerance_s", c.image_tolerance_s, Range{0.0, 0.1},
               "between a whole scan and its image");
  reader.field("disagree_limit_s", c.disagree_limit_s, Range{1e-5, 0.1},
               "two disciplined clocks further apart: one of them lies");
}

void describe_camera_offset(ConfigReader& reader, sync::CameraOffset::Config& c) {
  reader.field("limit_s", c.limit_s, Range{0.0, 0.05},
               "pictures further off LiDAR and IMU colour no points; 0 = not looked at");
  reader.field("window_s", c.window_s, Range{5.0, 120.0}, "what an estimate is made of");
}

void describe_uplink(ConfigReader& reader, uplink::UplinkConfig& c) {
  reader.field("robot", c.robot.value, {1, 32767},
               "this robot's number, origin of its own Gaussians; deltas for others are refused");
  reader.field("queue_keyframes", c.queue_keyframes, {1, 1024}, "waiting keyframes, oldest dropped first");
  reader.field("heartbeat_period_s", c.heartbeat_period_s, Range{0.05, 10.0}, "to the server");
  reader.field("full_bytes_per_s", c.router.full_bytes_per_s, Range{0.0, 1e9},
               "mean of all that is sent in FULL, 0 = no limit");
  reader.field("lean_bytes_per_s", c.router.lean_bytes_per_s, Range{0.0, 1e9}, "and in LEAN");
  reader.field("lean_every", c.router.lean_every, {1, 100},
               "of the keyframes in LEAN one in so many is sent");
  reader.field("full_keyframe_bytes", c.full_keyframe_bytes, {0, 1U << 25U},
               "larger keyframes are slimmed to about this in FULL, 0 = never");
  reader.field("lean_keyframe_bytes", c.lean_keyframe_bytes, {0, 1U << 25U}, "and in LEAN");
  reader.field("spool_memory_bytes", c.spool.memory_bytes, {0, std::size_t{1} << 40U},
               "keyframes that were not sent, in memory");
  reader.field("spool_disk_bytes", c.spool.disk_bytes, {0, std::size_t{1} << 40U},
               "and in the run folder, oldest dropped first");
}

void describe_offload(ConfigReader& reader, OffloadSettings& c) {
  policy::OffloadConfig& p = c.policy;
  reader.choice("setting", p.setting,
                {{"auto", policy::OffloadSetting::kAuto},
                 {"always", policy::OffloadSetting::kAlways},
                 {"never", policy::OffloadSetting::kNever}},
                "auto = when rendering is slow or memory short, always = whenever the link allows it");
  reader.field("latency_threshold_ms", p.latency_threshold_ms, Range{0.001, 1000.0},
               "a picture's render time, p95 of 2 s");
  reader.field("memory_threshold_bytes", p.memory_threshold_bytes, Range{1e6, 1e12}, "of this process");
  reader.field("memory_reserve_bytes", c.memory_reserve_bytes, {0, std::uint64_t{1} << 40U},
               "less left in the machine counts as memory short");
  reader.field("full_bandwidth_bytes_per_s", p.full_bandwidth_bytes_per_s, Range{1e3, 1e9}, "FULL needs");
  reader.field("lean_bandwidth_bytes_per_s", p.lean_bandwidth_bytes_per_s, Range{1e3, 1e9}, "LEAN needs");
  reader.field("round_trip_threshold_ms", p.round_trip_threshold_ms, Range{1.0, 10000.0}, "both need less");
  reader.field("switch_interval_s", p.switch_interval_s, Range{0.0, 600.0},
               "an upgrade waits this long after a switch");
  reader.field("server_timeout_s", p.server_timeout_s, Range{0.5, 60.0},
               "without a heartbeat the server is lost");
  reader.field("evaluation_period_s", p.evaluation_period_s, Range{0.05, 5.0}, "between two decisions");
  reader.field("windows_in_a_row", p.windows_in_a_row, {1, 20}, "decisions that must agree");
  if (p.full_bandwidth_bytes_per_s <= p.lean_bandwidth_bytes_per_s) {
    reader.problem("full_bandwidth_bytes_per_s", "must be more than lean_bandwidth_bytes_per_s");
  }
}

void describe_map(ConfigReader& reader, map::ResidentMapConfig& c) {
  reader.field("budget_bytes", c.budget_bytes, {1 << 20, std::size_t{1} << 40U},
               "memory of resident Gaussians");
  reader.field("max_held_deltas", c.max_held_deltas, {1, 4096}, "deltas that wait for one before them");
  reader.field("publish_period_s", c.publish_period_s, Range{0.0, 10.0}, "least time between two snapshots");
}

void describe_local(ConfigReader& reader, local_mapping::LocalMappingConfig& c) {
  reader.field("enabled", c.enabled, "map on the robot in LOCAL, and without a server");
  reader.field("core_share", c.core_share, Range{0.01, 1.0}, "of one core for keyframes and steps");
  reader.field("budget_bytes", c.budget_bytes, {1 << 20, std::size_t{1} << 40U},
               "the robot's own Gaussians with what training needs, and training pictures");
  reader.field("queue_keyframes", c.queue_keyframes, {1, 256}, "waiting keyframes, oldest dropped first");
  reader.field("publish_period_s", c.publish_period_s, Range{0.0, 10.0},
               "least time between two maps for the renderer");
  reader.field("lockstep_steps", c.lockstep_steps, {0, 10000}, "after each keyframe of a lockstep run");
  reader.field("views_when_short", c.views_when_short, {1, 64},
               "newest training pictures that pruning leaves");
}

void describe_server(ConfigReader& reader, ServerLink& c) {
  reader.field("enabled", c.enabled, "share the map with a server");
  reader.field("drain_s", c.drain_s, Range{0.0, 60.0}, "at the end, wait this long for the server's answers");
  reader.table("link", "the network to the server", [&] { describe(reader, c.link); });
}

}  // namespace

void describe(ConfigReader& reader, RobotConfig& c) {
  reader.tables("livox", c.livox, sensor::kMostLidars,
                "a LiDAR; [[livox]] for each of several, in the order of the rig", livox_defaults,
                [&](LivoxSettings& livox) { describe_livox(reader, livox); });
  check_livox(reader, c.livox);
  reader.table("camera", "the camera", [&] { describe_camera(reader, c.camera); });
  reader.table("serial", "an inertial sensor or trigger pulses on a serial line",
               [&] { describe_serial(reader, c.serial); });
  reader.table("pps", "the pulse-per-second line", [&] { describe_pps(reader, c.pps); });
  reader.table("ptp", "the watch over PTP on this machine", [&] { describe_ptp(reader, c.ptp); });
  reader.table("sync", "measurements to groups", [&] { describe_sync(reader, c.sync); });
  reader.table("camera_offset", "a check of the camera's stamps by what it sees",
               [&] { describe_camera_offset(reader, c.camera_offset); });
  reader.table("tracking", "groups to poses", [&] { describe(reader, c.tracking); });
  reader.table("keyframe", "poses and pictures to keyframes", [&] { describe(reader, c.keyframe); });
  reader.table("uplink", "keyframes to the server", [&] { describe_uplink(reader, c.uplink); });
  reader.table("offload", "where the mapping is done", [&] { describe_offload(reader, c.offload); });
  reader.table("map", "the resident map", [&] { describe_map(reader, c.map); });
  reader.table("local", "the robot's own mapping", [&] { describe_local(reader, c.local); });
  reader.table("record", "of --record", [&] {
    reader.field("min_free_bytes", c.record.min_free_bytes, {0, std::uint64_t{1} << 50U},
                 "less left on its disk ends the recording; the run goes on");
    reader.field("sync_period_s", c.record.sync_period_s, Range{0.0, 3600.0},
                 "what a power cut may cost; 0 = left to the system");
  });
  reader.table("render", "the live picture", [&] {
    reader.field("target_hz", c.render.target_hz, Range{0.0, 120.0}, "pictures a second, 0 = never");
  });
  reader.table("server", "the edge server", [&] { describe_server(reader, c.server); });
}

}  // namespace edgesplat::robot_config
