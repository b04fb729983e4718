// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/image_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// What image_file.cpp needs from the two codecs. Inside common/io only.
namespace edgesplat::io::codec {

[[nodiscard]] bool is_jpeg(std::span<const std::byte> bytes);
[[nodiscard]] bool is_png(std::span<const std::byte> bytes);
[[nodiscard]] Result<ImageHeader> read_jpeg_header(std::span<const std::byte> bytes);
[[nodiscard]] Result<ImageHeader> read_png_header(std::span<const std::byte> bytes);
[[nodiscard]] Result<AnyImage> decode_jpeg(std::span<const std::byte> bytes);
[[nodiscard]] Result<AnyImage> decode_png(std::span<const std::byte> bytes);

/// 1..kMaxImageSide_px on both sides, else `code`.
[[nodiscard]] Status check_size(int width_px, int height_px, Errc code);

/// Rows of a picture to be written as PNG, size already checked; `bits` a channel 8 or 16 (host order).
struct PngRows {
  const void* first = nullptr;
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  int bits = 0;
};
[[nodiscard]] Result<std::vector<std::byte>> encode_png_rows(const PngRows& rows, int level);
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg_rows(const std::uint8_t* first, int width_px,
                                                              int height_px, int channels, int quality);

}  // namespace edgesplat::io::codec
