// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/local_address.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>

namespace edgesplat {
namespace {

in_addr address(const char* text) {
  in_addr parsed{};
  EXPECT_EQ(::inet_pton(AF_INET, text, &parsed), 1);
  return parsed;
}

TEST(LocalAddress, IsTheOneThatTheRouteTakes) {
  const auto source = source_towards(address("127.0.0.9"));
  ASSERT_TRUE(source.has_value());
  EXPECT_EQ(ntohl(source->s_addr) >> 24U, 127U);
}

TEST(LocalAddress, BroadcastsGoToEveryNetworkButLoopback) {
  for (const in_addr source : broadcast_sources()) EXPECT_NE(ntohl(source.s_addr) >> 24U, 127U);
}

}  // namespace
}  // namespace edgesplat
