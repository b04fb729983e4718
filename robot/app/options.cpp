// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/options.hpp"

#include <CLI/CLI.hpp>

namespace edgesplat::app {

ParsedOptions parse_options(int argc, char** argv) {
  ParsedOptions parsed;
  Options& o = parsed.options;
  CLI::App app{"edgesplat-robot: capture, tracking, streamed map and rendering on the robot",
               "edgesplat-robot"};
  app.set_version_flag("--version", "edgesplat-robot " EDGESPLAT_VERSION);
  app.footer("Exit codes: 0 done, 1 failed, 2 usage or configuration. SIGINT and SIGTERM end a run cleanly.");
  bool live = false;
  auto* live_flag = app.add_flag("--live", live, "Read the sensors (Livox over UDP, camera over TCP)");
  app.add_option(
         "--replay", o.replay,
         "Read a recording instead: .mcap, KITTI-like folder, folder of .bin scans, or with --rig one of ROS "
         "(.bag, .mcap, .db3)")
      ->excludes(live_flag);
  app.add_option("--config", o.config_file, "Configuration (TOML)");
  app.add_option("--set", o.overrides, "Override one setting, key=value; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--rig", o.rig_file,
                 "Which sensors there are and where they sit (TOML); default: the recording's");
  app.add_flag("--lockstep", o.lockstep, "Replay in virtual time: the same bytes in give the same bits out");
  app.add_option("--speed", o.speed, "Replay pace: 1 real time, 0 as fast as possible")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--seconds", o.seconds, "Stop after this much recorded time; 0: all")
      ->check(CLI::Range(0.0, 1e7));
  app.add_option("--threads", o.threads, "Threads of the tracking loops")->check(CLI::Range(1, 64));
  app.add_option("--record", o.record, "With --live: write every byte that arrives into this .mcap");
  app.add_option("--out", o.out, "Run folder for trajectory, metrics, map and pictures");
  std::string server;
  app.add_option("--server", server, "Share the map with a server")->check(CLI::IsMember({"on", "off"}));
  app.add_option("--offload", o.offload,
                 "When the server does the mapping: auto = when rendering is slow or memory short, always = "
                 "whenever the link allows it, never")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  app.add_option("--interface", o.interface_name, "Network interface to the server");
  app.add_option("--domain", o.domain, "DDS domain, shared with the server")->check(CLI::Range(0, 230));
  app.add_option("--points-port", o.points_port, "UDP port of the LiDAR's points")
      ->check(CLI::Range(1, 65535));
  app.add_option("--imu-port", o.imu_port, "UDP port of the LiDAR's IMU")->check(CLI::Range(1, 65535));
  app.add_option("--frame-port", o.frame_port, "TCP port of the camera")->check(CLI::Range(1, 65535));
  app.add_flag("--check-config", o.check_config, "Check configuration and rig, then end");
  app.add_flag("--print-config", o.print_config, "Print the effective configuration as TOML, then end");
  app.add_flag("--json-progress", o.json_progress, "One JSON line a second on stdout");
  try {
    app.parse(argc, argv);
    if (!live && o.replay.empty() && !o.check_config && !o.print_config) {
      throw CLI::ValidationError("nothing to do", "name a source: --live or --replay PATH");
    }
    if (!o.record.empty() && !live) throw CLI::ValidationError("--record", "needs --live");
    if (o.lockstep && o.replay.empty()) throw CLI::ValidationError("--lockstep", "needs --replay PATH");
  } catch (const CLI::ParseError& error) {
    parsed.exit_now = app.exit(error) == 0 ? 0 : 2;
  }
  if (!server.empty()) o.server = server == "on";
  return parsed;
}

}  // namespace edgesplat::app
