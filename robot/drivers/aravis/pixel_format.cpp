// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/pixel_format.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstring>
#include <string>

namespace edgesplat::aravis {
namespace {

constexpr int kMaxSide_px = 16'384;

std::size_t bytes_needed(PixelFormat format, int width_px, int height_px) {
  const std::size_t pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  return format == PixelFormat::kRgb8 ? 3 * pixels : pixels;
}

}  // namespace

std::string_view to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::kMono8:
      return "Mono8";
    case PixelFormat::kBayerRg8:
      return "BayerRG8";
    case PixelFormat::kRgb8:
      return "RGB8";
  }
  return "unknown";
}

std::optional<PixelFormat> pixel_format_of(std::uint32_t code) {
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kBayerRg8, PixelFormat::kRgb8})
    if (code == static_cast<std::uint32_t>(format)) return format;
  return std::nullopt;
}

Result<sensor::ImageRgb8> to_rgb8(PixelFormat format, int width_px, int height_px,
                                  std::span<const std::byte> pixels) {
  const auto is_side = [](int side_px) { return side_px >= 2 && side_px <= kMaxSide_px; };
  if (!is_side(width_px) || !is_side(height_px) || pixels.size() < bytes_needed(format, width_px, height_px))
    return fail(Errc::kBadPacket, "a picture of " + std::to_string(width_px) + "x" +
                                      std::to_string(height_px) + " pixels does not fit in the " +
                                      std::to_string(pixels.size()) + " bytes that came");
  sensor::ImageRgb8 out(width_px, height_px);
  if (format == PixelFormat::kRgb8) {
    std::memcpy(out.values.data(), pixels.data(), out.values.size());
    return out;
  }
  // OpenCV does not write to its input; its interface only has no const.
  auto* in = const_cast<std::byte*>(pixels.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  const cv::Mat grey(height_px, width_px, CV_8UC1, in);
  cv::Mat colour(height_px, width_px, CV_8UC3, out.values.data());
  // OpenCV names a mosaic by the second line's second and third pixel: its BG is the RG of the camera.
  cv::cvtColor(grey, colour, format == PixelFormat::kMono8 ? cv::COLOR_GRAY2RGB : cv::COLOR_BayerBG2RGB);
  return out;
}

}  // namespace edgesplat::aravis
