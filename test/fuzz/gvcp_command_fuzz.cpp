// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "tools/virtual_device/gige_gvcp.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// One datagram on the virtual camera's command port: as it is, and with its header made right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  using namespace edgesplat::virtual_device;
  const auto check = [](std::span<const std::byte> datagram) {
    const GvcpDecoded decoded = decode_gvcp(datagram);
    if (const auto* fault = std::get_if<GvcpFault>(&decoded)) {
      EDGESPLAT_CHECK(!fault->answer || fault->answer->size() == 8, "an error is a header");
      return;
    }
    const auto& command = std::get<GvcpCommand>(decoded);
    EDGESPLAT_CHECK(gvcp_error(command, GvcpStatus::kAccessDenied).size() == 8, "an error is a header");
    if (const auto* write = std::get_if<GvcpWriteMemory>(&command.what)) {
      EDGESPLAT_CHECK(write->data.data() >= datagram.data() &&
                          write->data.data() + write->data.size() <= datagram.data() + datagram.size(),
                      "data are the datagram's");
    }
  };
  const auto datagram = std::as_bytes(std::span(bytes, size));
  check(datagram);
  if (size < 8) return 0;
  std::vector<std::byte> framed(datagram.begin(), datagram.end());
  framed[0] = std::byte{0x42};
  framed[4] = static_cast<std::byte>((size - 8) >> 8U);
  framed[5] = static_cast<std::byte>((size - 8) & 0xFFU);
  check(framed);
  return 0;
}
