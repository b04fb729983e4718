// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/image_file.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat::io;
  const auto bytes = std::as_bytes(std::span(first, size));
  const auto header = read_image_header(bytes);
  const auto image = decode_rgb8(bytes);
  if (!image) return 0;
  EDGESPLAT_CHECK(header && header->width_px == image->width_px && header->height_px == image->height_px,
                  "header and picture must agree");
  return 0;
}
