// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/link_config.hpp"

#include <string_view>

namespace edgesplat::link {
namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string peer_elements(std::string_view peers) {
  std::string out;
  while (!peers.empty()) {
    const std::size_t comma = peers.find(',');
    std::string_view peer = peers.substr(0, comma);
    peers = comma == std::string_view::npos ? std::string_view{} : peers.substr(comma + 1);
    while (peer.starts_with(' ')) peer.remove_prefix(1);
    while (peer.ends_with(' ')) peer.remove_suffix(1);
    if (!peer.empty()) out += "<Peer address=\"" + escaped(peer) + "\"/>";
  }
  return out;
}

}  // namespace

void describe(config::ConfigReader& reader, LinkConfig& config) {
  using config::Range;
  reader.field("interface", config.interface, "name of the network interface (ip link)");
  reader.field("peers", config.peers, "addresses of the other ends, separated by commas");
  reader.field("domain", config.domain, Range{0, 230}, "DDS domain, the same at both ends");
  reader.field("multicast_discovery", config.multicast_discovery,
               "find peers by multicast as well (not on lo)");
  reader.field("queue_messages", config.queue_messages, {1, 4096}, "waiting to be sent, per lane");
  reader.field("queue_megabytes", config.queue_megabytes, {1, 1024}, "the same in MiB");
  reader.field("inbox_messages", config.inbox_messages, {1, 4096}, "received and not yet taken");
  reader.table("impair", "what this end sends is made worse on purpose, for demonstrations and tests",
               [&] { describe(reader, config.impair); });
}

SendLimits send_limits(const LinkConfig& config) {
  return {config.queue_messages, config.queue_megabytes << 20U, {}};
}

std::string cyclone_xml(const LinkConfig& config) {
  std::string xml = "<CycloneDDS><Domain id=\"any\"><General><Interfaces><NetworkInterface name=\"";
  xml += escaped(config.interface) + "\"/></Interfaces><AllowMulticast>";
  xml += config.multicast_discovery ? "spdp" : "false";
  // 1400 B: above it one lost IP fragment costs a whole message on Wi-Fi.
  xml +=
      "</AllowMulticast><MaxMessageSize>1400B</MaxMessageSize><FragmentSize>1344B</FragmentSize></General>";
  xml +=
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</"
      "MaxAutoParticipantIndex>";
  xml += "<LeaseDuration>2s</LeaseDuration><Peers>" + peer_elements(config.peers) + "</Peers></Discovery>";
  // A peer cannot make this end set aside more than four chunks' worth for one sample.
  xml += "<Internal><MaxSampleSize>256KiB</MaxSampleSize></Internal>";
  xml += "</Domain></CycloneDDS>";
  return xml;
}

}  // namespace edgesplat::link
