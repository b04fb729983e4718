// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/link_config.hpp"

#include <gmock/gmock.h>

namespace edgesplat::link {
namespace {

using ::testing::HasSubstr;

TEST(CycloneXml, NamesTheInterfaceAndEveryPeer) {
  LinkConfig config;
  config.interface = "wlan0";
  config.peers = "10.0.0.1, 10.0.0.2";
  const std::string xml = cyclone_xml(config);
  EXPECT_THAT(xml, HasSubstr("<NetworkInterface name=\"wlan0\"/>"));
  EXPECT_THAT(xml, HasSubstr("<Peer address=\"10.0.0.1\"/><Peer address=\"10.0.0.2\"/>"));
  EXPECT_THAT(xml, HasSubstr("<MaxMessageSize>1400B</MaxMessageSize>"));
  EXPECT_THAT(xml, HasSubstr("<AllowMulticast>false</AllowMulticast>"));
  EXPECT_THAT(xml, HasSubstr("<LeaseDuration>2s</LeaseDuration>"));
}

TEST(CycloneXml, TextFromOutsideCannotAddElements) {
  LinkConfig config;
  config.interface = "lo\"/><Evil>&";
  EXPECT_THAT(cyclone_xml(config), HasSubstr("name=\"lo&quot;/&gt;&lt;Evil&gt;&amp;\""));
}

}  // namespace
}  // namespace edgesplat::link
