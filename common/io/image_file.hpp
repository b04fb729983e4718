// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <variant>
#include <vector>

namespace edgesplat::io {

enum class ImageFormat { kJpeg, kPng };
using AnyImage = std::variant<sensor::ImageGray8, sensor::ImageGray16, sensor::ImageRgb8>;

/// Largest accepted side; a picture must also be plausible for its compressed size, so that a small hostile
/// file cannot ask for much memory.
inline constexpr int kMaxImageSide_px = 16384;

struct ImageHeader {
  ImageFormat format = ImageFormat::kJpeg;
  int width_px = 0;
  int height_px = 0;
};

/// Format and size from the first bytes, nothing decoded. kCorrupt for anything but JPEG and PNG.
[[nodiscard]] Result<ImageHeader> read_image_header(std::span<const std::byte> bytes);
/// JPEG -> gray8 or rgb8; PNG -> gray8, gray16 or rgb8 (palette expanded, alpha dropped, rgb16 cut to 8
/// bits). kCorrupt for damaged or truncated pictures: half a picture is none.
[[nodiscard]] Result<AnyImage> decode_image(std::span<const std::byte> bytes);
/// The same as rgb8: grey becomes three equal channels, 16 bits keep the upper 8.
[[nodiscard]] Result<sensor::ImageRgb8> decode_rgb8(std::span<const std::byte> bytes);
/// A mask; kCorrupt where the picture is not gray8.
[[nodiscard]] Result<sensor::ImageGray8> decode_gray8(std::span<const std::byte> bytes);
/// A depth picture; kCorrupt where the picture is not gray16.
[[nodiscard]] Result<sensor::ImageGray16> decode_gray16(std::span<const std::byte> bytes);

/// kInvalidArgument for an empty picture, one beyond kMaxImageSide_px or a quality outside 1..100.
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const sensor::ImageRgb8& image, int quality = 90);
[[nodiscard]] Result<std::vector<std::byte>> encode_jpeg(const sensor::ImageGray8& image, int quality = 90);
/// Lossless; level 1 (fast) to 9 (small).
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const sensor::ImageRgb8& image, int level = 3);
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const sensor::ImageGray8& image, int level = 3);
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const sensor::ImageGray16& image, int level = 3);

[[nodiscard]] Result<AnyImage> load_image(const std::filesystem::path& path);
[[nodiscard]] Result<sensor::ImageRgb8> load_rgb8(const std::filesystem::path& path);
/// Atomically; .jpg, .jpeg (quality 90, not for gray16) or .png, else kInvalidArgument.
[[nodiscard]] Status save_image(const std::filesystem::path& path, const AnyImage& image);

}  // namespace edgesplat::io
