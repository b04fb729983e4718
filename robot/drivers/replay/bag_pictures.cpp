// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_pictures.hpp"

#include "common/io/image_file.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace edgesplat::replay {
namespace {

struct PixelLayout {
  std::string_view encoding;
  int channels;
  std::optional<int> to_rgb;  ///< OpenCV's conversion; none: it is RGB already
};

// OpenCV names a mosaic by the second line's second and third pixel: its BG is everybody's RGGB.
constexpr std::array<PixelLayout, 11> kLayouts{{{"mono8", 1, cv::COLOR_GRAY2RGB},
                                                {"8UC1", 1, cv::COLOR_GRAY2RGB},
                                                {"rgb8", 3, std::nullopt},
                                                {"bgr8", 3, cv::COLOR_BGR2RGB},
                                                {"8UC3", 3, cv::COLOR_BGR2RGB},
                                                {"rgba8", 4, cv::COLOR_RGBA2RGB},
                                                {"bgra8", 4, cv::COLOR_BGRA2RGB},
                                                {"bayer_rggb8", 1, cv::COLOR_BayerBG2RGB},
                                                {"bayer_bggr8", 1, cv::COLOR_BayerRG2RGB},
                                                {"bayer_gbrg8", 1, cv::COLOR_BayerGR2RGB},
                                                {"bayer_grbg8", 1, cv::COLOR_BayerGB2RGB}}};

const PixelLayout* find_layout(std::string_view encoding) {
  const auto place = std::find_if(kLayouts.begin(), kLayouts.end(),
                                  [&](const PixelLayout& layout) { return layout.encoding == encoding; });
  return place == kLayouts.end() ? nullptr : &*place;
}

/// `pixels`: height rows, `step_bytes` apart, each of width pixels of the layout.
sensor::ImageRgb8 convert(const PixelLayout& layout, int width_px, int height_px, const std::byte* pixels,
                          std::size_t step_bytes) {
  // OpenCV does not write to its input; its interface only has no const.
  auto* in = const_cast<std::byte*>(pixels);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  const cv::Mat from(height_px, width_px, CV_8UC(layout.channels), in, step_bytes);
  sensor::ImageRgb8 out(width_px, height_px);
  cv::Mat to(height_px, width_px, CV_8UC3, out.values.data());
  if (layout.to_rgb) {
    cv::cvtColor(from, to, *layout.to_rgb);
  } else {
    from.copyTo(to);
  }
  return out;
}

}  // namespace

Result<sensor::ImageRgb8> picture_of(const io::RosImage& image) {
  const PixelLayout* layout = find_layout(image.encoding);
  if (layout == nullptr) {
    return fail(Errc::kCorrupt, "pictures of encoding '" + std::string(image.encoding.substr(0, 32)) +
                                    "' cannot be read: mono8, rgb8, bgr8, rgba8, bgra8 and bayer_*8 can");
  }
  constexpr std::uint32_t kMaxSide_px = io::kMaxImageSide_px;
  // A mosaic of one line or column has no neighbours to take colours from.
  const std::uint32_t least_px = image.encoding.starts_with("bayer") ? 4U : 1U;
  const auto is_side = [&](std::uint32_t px) { return px >= least_px && px <= kMaxSide_px; };
  const std::uint64_t row_bytes =
      std::uint64_t{image.width_px} * static_cast<std::uint64_t>(layout->channels);
  if (!is_side(image.width_px) || !is_side(image.height_px) || image.step_bytes < row_bytes ||
      std::uint64_t{image.height_px - 1} * image.step_bytes + row_bytes > image.data.size()) {
    return fail(Errc::kCorrupt, "a picture of " + std::to_string(image.width_px) + "x" +
                                    std::to_string(image.height_px) + " pixels does not fit in " +
                                    std::to_string(image.data.size()) + " bytes");
  }
  return convert(*layout, static_cast<int>(image.width_px), static_cast<int>(image.height_px),
                 image.data.data(), image.step_bytes);
}

Result<sensor::ImageRgb8> picture_of(const io::RosCompressedImage& image) {
  // "bayer_rggb8; jpeg compressed": the mosaic itself was compressed.
  const std::string_view encoding = image.format.substr(0, image.format.find(';'));
  const PixelLayout* layout = encoding.starts_with("bayer_") ? find_layout(encoding) : nullptr;
  if (layout == nullptr) return io::decode_rgb8(image.data);
  EDGESPLAT_TRY(const io::AnyImage decoded, io::decode_image(image.data));
  const auto* grey = std::get_if<sensor::ImageGray8>(&decoded);
  constexpr int kLeastMosaicSide_px = 4;
  if (grey == nullptr || grey->width_px < kLeastMosaicSide_px || grey->height_px < kLeastMosaicSide_px)
    return io::decode_rgb8(image.data);
  const auto bytes = std::as_bytes(std::span(grey->values));
  return convert(*layout, grey->width_px, grey->height_px, bytes.data(),
                 static_cast<std::size_t>(grey->width_px));
}

}  // namespace edgesplat::replay
