// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "robot/drivers/aravis/gvcp_finder.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

/// What somebody on the network answers to a discovery command: as it is, and with the header made right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  using namespace edgesplat::aravis;
  const auto datagram = std::as_bytes(std::span(bytes, size));
  (void)read_discovery_answer(datagram, 1);
  std::vector<std::byte> whole(8 + 0xF8);
  std::copy_n(datagram.begin(), std::min(datagram.size(), std::size_t{0xF8}), whole.begin() + 8);
  whole[3] = std::byte{0x03};
  whole[5] = std::byte{0xF8};
  whole[7] = std::byte{0x01};
  const auto camera = read_discovery_answer(whole, 1);
  EDGESPLAT_CHECK(camera.has_value(), "a whole answer is one");
  EDGESPLAT_CHECK(camera->serial_number.size() <= 16 && camera->maker.size() <= 32,
                  "texts stay in their fields");
  EDGESPLAT_CHECK(is_same_camera(*camera, *camera), "a camera is itself");
  return 0;
}
