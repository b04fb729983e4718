// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/config/server_config.hpp"

#include "common/config/config_file.hpp"

#include <gmock/gmock.h>

namespace edgesplat::config {
namespace {

TEST(ServerConfig, ReadsBackWhatItPrints) {
  ServerConfig config;
  config.link.interface = "eth0";
  config.optimise.engine.seed.coverage.near_cell_m = 0.08F;
  config.max_robots = 9;
  const auto file = ConfigFile::parse(to_toml(config), "printed");
  ASSERT_TRUE(file.has_value()) << file.error().context;
  ServerConfig back;
  const auto status = file->read_into(back);
  ASSERT_TRUE(status.has_value()) << status.error().context;
  EXPECT_EQ(back.link.interface, "eth0");
  EXPECT_EQ(back.optimise.engine.seed.coverage.near_cell_m, 0.08F);
  EXPECT_EQ(back.max_robots, 9U);
}

TEST(ServerConfig, NamesEveryMistakeWithItsLine) {
  const auto file =
      ConfigFile::parse("log_level = \"loud\"\nmax_robots = 0\n[link]\ndomian = 3\n", "server.toml");
  ASSERT_TRUE(file.has_value());
  ServerConfig config;
  const auto status = file->read_into(config);
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(status.error().context, ::testing::HasSubstr("server.toml:1"));
  EXPECT_THAT(status.error().context, ::testing::HasSubstr("server.toml:2"));
  EXPECT_THAT(status.error().context, ::testing::HasSubstr("server.toml:4"));
}

}  // namespace
}  // namespace edgesplat::config
