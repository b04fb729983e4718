// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/mcap_reader.hpp"
#include "common/time/clock.hpp"
#include "test/integration/program.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

namespace edgesplat::test {

/// The robot's program killed while it records, and its recording made whole again.
class KilledRecording : public testing::Test {
 protected:
  KilledRecording() {
    recording_ = shared_recording(
        "corridor6", {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
    const auto extracted = run_program(
        "edgesplat", {"inspect", recording_, "--extract", "rig.toml", "--to", in_folder("rig.toml")});
    EXPECT_EQ(extracted.exit_code, 0) << extracted.err;
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_.path() / name; }

  /// Records for `seconds` after the camera has come, and is killed then. When that was, as the robot counts.
  HostTime record_and_kill(const std::string& path, double seconds) {
    const std::vector<std::string> ports = {"--points-port", port(0),        "--imu-port",
                                            port(1),         "--frame-port", port(2)};
    std::vector<std::string> robot_arguments = {"--live",   "--rig", in_folder("rig.toml"), "--server", "off",
                                                "--record", path};
    robot_arguments.insert(robot_arguments.end(), ports.begin(), ports.end());
    std::vector<std::string> stream_arguments = {"stream", recording_, "--to", "127.0.0.1"};
    stream_arguments.insert(stream_arguments.end(), ports.begin(), ports.end());
    Program robot("edgesplat-robot", robot_arguments);
    EXPECT_TRUE(robot.wait_for_stderr("listening", std::chrono::seconds(20)));
    Program stream("edgesplat", stream_arguments);
    EXPECT_TRUE(robot.wait_for_stderr("camera: connected", std::chrono::seconds(20)));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    robot.signal(SIGKILL);
    const HostTime killed = SteadyClock().now();
    EXPECT_EQ(robot.wait(std::chrono::seconds(20)).exit_code, 128 + SIGKILL);
    stream.signal(SIGTERM);
    EXPECT_EQ(stream.wait(std::chrono::seconds(20)).exit_code, 0);
    return killed;
  }

  /// One round; what was lost, in seconds before the kill.
  double round(double seconds) {
    const std::string path = in_folder("live.mcap");
    const HostTime killed = record_and_kill(path, seconds);
    const auto recovered = run_program("edgesplat", {"recover", path, "--json"});
    EXPECT_EQ(recovered.exit_code, 0) << recovered.err;
    if (recovered.exit_code != 0) return 1e9;
    const auto figures = nlohmann::json::parse(recovered.out);
    EXPECT_FALSE(figures["was_whole"].get<bool>());
    EXPECT_EQ(figures["chunks_skipped"].get<int>(), 0);
    auto reader = io::McapReader::open(path);
    EXPECT_TRUE(reader && reader->report().complete && reader->report().used_summary);
    std::uint64_t messages = 0;
    while (reader && reader->next()) ++messages;
    EXPECT_EQ(messages, figures["messages"].get<std::uint64_t>());
    EXPECT_TRUE(reader && reader->report().complete) << reader->report().why;
    expect_others_read(path, messages);
    return to_seconds(killed - host_time_from_ns(figures["last_log_time_ns"].get<std::int64_t>()));
  }
  /// PyPI's mcap finds as many messages, by the summary and record by record; where tools/setup --peers put
  /// it.
  void expect_others_read(const std::string& path, std::uint64_t messages) {
    const char* chosen = std::getenv("EDGESPLAT_PEERS_PYTHON");
    const std::string python = chosen != nullptr ? chosen : EDGESPLAT_SOURCE_DIR "/.deps/peers/bin/python";
    has_peer_ = std::filesystem::exists(python);
    if (!has_peer_) return;
    const std::string script =
        "import mcap.reader, sys\n"
        "for kind in (mcap.reader.SeekingReader, mcap.reader.NonSeekingReader):\n"
        "    with open(sys.argv[1], 'rb') as stream:\n"
        "        count = sum(1 for _ in kind(stream, validate_crcs=True).iter_messages())\n"
        "    assert count == int(sys.argv[2]), (kind, count, sys.argv[2])\n";
    const std::string command =
        "'" + python + "' -c \"" + script + "\" '" + path + "' " + std::to_string(messages);
    EXPECT_EQ(std::system(command.c_str()), 0) << "PyPI's mcap does not read the recovered file";
  }

  bool has_peer_ = false;

 private:
  /// Below Linux' range of ephemeral ports, at a place of its own for each test process.
  static std::string port(int offset) { return std::to_string(20'000 + ::getpid() * 7 % 10'000 + offset); }

  TempDir folder_;
  std::string recording_;
};

}  // namespace edgesplat::test
