// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "server/store/map_file.hpp"
#include "server/store/record.hpp"

#include <algorithm>

// Twice: as a file, and as the payloads of well-framed records (type u8, length u16, payload), since no
// mutation would get past their checksums.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgesplat;
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  const auto check = [](std::span<const std::byte> file) {
    const auto loaded = store::read_map(file);
    if (loaded) EDGESPLAT_CHECK(loaded->map.gaussians.consistent(), "a loaded map's arrays agree");
  };
  check(input);
  ByteReader in(input);
  ByteWriter file;
  file.write_text("ESSM");
  file.write(std::uint16_t{1});
  while (in.remaining() > 3) {
    const auto type = in.read<std::uint8_t>();
    const std::size_t length = in.read<std::uint16_t>();
    const auto payload = in.take(std::min(length, in.remaining()));
    file.write_bytes(store::record_header(type, payload));
    file.write_bytes(payload);
  }
  check(file.bytes());
  return 0;
}
