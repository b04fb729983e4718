// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"
#include "robot/app/options.hpp"
#include "robot/app/run.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace edgesplat::desk {

void add_replay_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("replay", "Run the robot on a recording, as edgesplat-robot --replay does");
  auto options = std::make_shared<app::Options>();
  auto with_server = std::make_shared<bool>(false);
  verb->add_option("recording", options->replay,
                   "A .mcap, a KITTI-like folder, a folder of .bin scans, or with --rig a recording of ROS")
      ->required();
  verb->add_option("--out", options->out, "Run folder; `edgesplat report --run` reads it")->required();
  verb->add_option("--config", options->config_file, "The robot's configuration (TOML)");
  verb->add_option("--set", options->overrides, "Override one setting, key=value; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--rig", options->rig_file, "Sensors and where they sit, instead of the recording's");
  verb->add_flag("--lockstep", options->lockstep,
                 "In virtual time: the same bytes in give the same bits out");
  options->speed = 0.0;
  verb->add_option("--speed", options->speed, "Pace: 1 real time, 0 as fast as possible (default)")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--seconds", options->seconds, "Stop after this much recorded time; 0: all");
  verb->add_option("--domain", options->domain, "DDS domain of the server")->check(CLI::Range(0, 230));
  verb->add_flag("--server", *with_server, "Share the map with a running edgesplat-server");
  verb->callback([options, with_server, &context] {
    context.work = [options, with_server] {
      options->server = *with_server;
      const thread::StopSignal stop_signal;
      return app::run_robot(*options, stop_signal.token());
    };
  });
}

}  // namespace edgesplat::desk
