// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/server.hpp"

#include "common/link/heartbeat.hpp"
#include "common/link/in_process_transport.hpp"
#include "common/map/keyframe_codec.hpp"
#include "server/app/options.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::app {
namespace {

constexpr map::RobotId kRobot{1};

struct Bench {
  config::ServerConfig config;
  SteadyClock clock;
  metrics::Registry registry;
  link::InProcessLink link = link::make_in_process_link(kRobot, 10000);
};

TEST(Server, AnswersKeyframesWithDeltasAndTellsItsHash) {
  Bench bench;
  Server server(bench.config, {map::Epoch{5}}, *bench.link.server, bench.registry, bench.clock);
  for (std::uint32_t id = 0; id < 3; ++id) {
    const auto bytes = map::encode_keyframe(test::wall_keyframe(id, 2000, 5.0 * id));
    ASSERT_TRUE(bench.link.robot->send(link::Lane::kKeyframe, kRobot, *bytes));
  }
  // Two deltas a keyframe: each shows another wall of less than 4096 cells, and is mapped then.
  std::uint64_t deltas = 0;
  while (deltas < 6) {
    const auto message = bench.link.robot->receive(std::chrono::seconds(20));
    ASSERT_TRUE(message.has_value());
    if (message->lane == link::Lane::kDelta) ++deltas;
  }
  EXPECT_LT(server.without_progress(), std::chrono::seconds(10));  // both threads come round
  server.finish(std::chrono::seconds(1));
  server.send_heartbeats();
  const auto message = bench.link.robot->receive(std::chrono::seconds(20));
  ASSERT_TRUE(message && message->lane == link::Lane::kHeartbeat);
  const auto heartbeat = link::decode_heartbeat(message->bytes);
  ASSERT_TRUE(heartbeat.has_value());
  EXPECT_EQ(heartbeat->epoch, map::Epoch{5});
  EXPECT_EQ(heartbeat->seq, 6U);
  EXPECT_EQ(heartbeat->map_hash, server.status().at(0).map_hash);
  EXPECT_EQ(bench.registry.histogram("server.keyframe_to_delta_ms").summary().count, 3U);
}

TEST(Server, FinishMapsWhatWasReceived) {
  Bench bench;
  {
    Server server(bench.config, {map::Epoch{1}}, *bench.link.server, bench.registry, bench.clock);
    (void)bench.link.robot->send(link::Lane::kKeyframe, kRobot,
                                 *map::encode_keyframe(test::wall_keyframe(0, 500)));
    while (bench.registry.counter("ingest.keyframes").value() == 0) {
      (void)bench.link.robot->receive(std::chrono::milliseconds(1));
    }
    server.finish(std::chrono::seconds(1));
    server.finish(std::chrono::seconds(1));  // again is no harm
  }
  EXPECT_EQ(bench.registry.counter("map.keyframes").value(), 1U);
}

Result<Options> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "edgesplat-server");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, DefaultsAndOverrides) {
  const auto options =
      parse({"--interface", "lo", "--domain", "7", "--set", "max_robots=2", "--idle-exit", "1.5"});
  ASSERT_TRUE(options.has_value()) << options.error().context;
  EXPECT_EQ(options->action, Options::Action::kRun);
  EXPECT_EQ(options->config.link.interface, "lo");
  EXPECT_EQ(options->config.link.domain, 7);
  EXPECT_EQ(options->config.max_robots, 2U);
  EXPECT_EQ(options->idle_exit_s, 1.5);
}

TEST(Options, MistakesAreUsageErrors) {
  for (const auto& arguments : std::vector<std::vector<const char*>>{
           {"--bogus"}, {"--set", "nosuch=1"}, {"--domain", "999"}, {"--config", "/nonexistent.toml"}}) {
    const auto options = parse(arguments);
    ASSERT_FALSE(options.has_value()) << arguments[0];
    EXPECT_EQ(exit_code(options.error()), 2);
  }
}

}  // namespace
}  // namespace edgesplat::app
