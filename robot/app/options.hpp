// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::app {

/// The command line of edgesplat-robot, checked for usage but not for content.
struct Options {
  std::filesystem::path config_file;   ///< empty: defaults
  std::vector<std::string> overrides;  ///< --set key=value
  std::filesystem::path rig_file;      ///< empty: from the recording
  std::filesystem::path replay;        ///< empty: live
  bool lockstep = false;               ///< replay in virtual time, one stage after the other
  double speed = 1.0;                  ///< replay pace; 0: as fast as the stages follow
  double seconds = 0.0;                ///< stop after this much recorded time; 0: all
  std::filesystem::path record;        ///< empty: none
  std::filesystem::path out;           ///< run folder; empty: nothing is written
  std::optional<int> threads;
  std::optional<bool> server;          ///< --server on|off
  std::optional<std::string> offload;  ///< --offload auto|always|never
  std::optional<std::string> interface_name;
  std::optional<int> domain;
  std::optional<int> points_port;
  std::optional<int> imu_port;
  std::optional<int> frame_port;
  bool check_config = false;
  bool print_config = false;
  bool json_progress = false;
};

/// Parses argv. Returns an exit code where the program is to end at once (help, version, usage error).
struct ParsedOptions {
  Options options;
  std::optional<int> exit_now;
};
[[nodiscard]] ParsedOptions parse_options(int argc, char** argv);

}  // namespace edgesplat::app
