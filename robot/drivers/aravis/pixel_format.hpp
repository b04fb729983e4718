// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace edgesplat::aravis {

/// What a GigE Vision camera may send that this driver understands; the values are those of the pixel format
/// naming convention (EMVA PFNC).
enum class PixelFormat : std::uint32_t {
  kMono8 = 0x0108'0001,
  kBayerRg8 = 0x0108'0009,  ///< red at (0, 0), blue at (1, 1)
  kRgb8 = 0x0218'0014,
};

/// "Mono8", "BayerRG8", "RGB8": the entry of the feature PixelFormat.
[[nodiscard]] std::string_view to_string(PixelFormat format);
/// Nothing for a code that is none of them.
[[nodiscard]] std::optional<PixelFormat> pixel_format_of(std::uint32_t code);

/// Pixels as they came, row-major without padding, to colour: grey is repeated, a mosaic interpolated
/// (bilinear). kBadPacket where there are fewer bytes than the size needs, or the size is not 2..16384 pixels
/// a side.
[[nodiscard]] Result<sensor::ImageRgb8> to_rgb8(PixelFormat format, int width_px, int height_px,
                                                std::span<const std::byte> pixels);

}  // namespace edgesplat::aravis
