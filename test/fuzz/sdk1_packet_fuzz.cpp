// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_source.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// One SDK1 data packet as it is, and again cut or filled to the length of its type, so that the records are
/// reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  constexpr std::array<std::size_t, 9> kLengths{1318, 918, 1362, 978, 1362, 786, 42, 1278, 678};
  std::vector<std::byte> datagram(size);
  std::copy_n(std::as_bytes(std::span(bytes, size)).begin(), size, datagram.begin());
  livox::LivoxSource source(livox::Protocol::kSdk1);
  std::int64_t now_ns = 0;
  const auto feed = [&] {
    for (int repeat = 0; repeat < 2; ++repeat) {
      (void)source.on_points(datagram, host_time_from_ns(++now_ns));
      (void)source.on_imu(datagram, host_time_from_ns(++now_ns));
    }
  };
  feed();
  if (size < livox::kSdk1HeaderBytes) return 0;
  datagram[9] =
      std::byte{static_cast<unsigned char>(std::to_integer<unsigned>(datagram[9]) % kLengths.size())};
  datagram.resize(kLengths.at(std::to_integer<std::size_t>(datagram[9])), std::byte{0x5A});
  feed();
  return 0;
}
