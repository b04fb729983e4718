// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "tools/virtual_device/gige_device.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// Datagrams of lengths that the input gives, from two hosts, with a pulse between them: whatever is written
/// into the registers, every packet of every frame can be made and asked for again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  using namespace edgesplat::virtual_device;
  static const auto picture = std::make_shared<const sensor::ImageRgb8>(8, 4, std::uint8_t{9});
  static const GigeDevice fresh({.width_px = 8, .height_px = 4});  // its description takes a while to write
  static GigeDevice device = fresh;
  auto rest = std::as_bytes(std::span(bytes, size));
  std::int64_t now_ns = 0;
  std::vector<std::byte> packet;
  while (rest.size() > 1) {
    const auto head = std::to_integer<unsigned>(rest[0]);
    const std::size_t length = std::min<std::size_t>(head & 0x7FU, rest.size() - 1);
    const GigePeer from{0x7F000001, static_cast<std::uint16_t>(1000 + (head >> 7U))};
    now_ns += 500'000'000;
    const auto answer = device.on_datagram(rest.subspan(1, length), from, host_time_from_ns(now_ns));
    EDGESPLAT_CHECK(answer.size() <= 8 + kGvcpMaxPayloadBytes, "answers stay within the protocol");
    rest = rest.subspan(1 + length);
    const auto frame = device.expose({picture, sensor_time_from_ns(now_ns), 100.0F, 0.0F});
    const std::uint32_t packet_bytes = device.registers().packet_bytes();
    for (std::uint32_t i = 0; frame && i < gvsp_packet_count(frame->payload.size(), packet_bytes); ++i) {
      encode_gvsp_packet(*frame, i, packet_bytes, GvspStatus::kFirst, packet);
      EDGESPLAT_CHECK(packet.size() + kIpUdpHeaderBytes <= packet_bytes, "packets stay within their size");
    }
    while (const auto wanted = device.take_resend()) (void)device.find_frame(wanted->frame);
    (void)device.take_test_packet_bytes();
    (void)device.take_triggered_frame();
    device.tick(host_time_from_ns(now_ns));
  }
  device = fresh;  // into the same memory: asking the system for 150 KiB anew costs more than all the rest
  return 0;
}
