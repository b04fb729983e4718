// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/slim_keyframe.hpp"

#include "common/io/image_file.hpp"

#include <array>
#include <utility>

namespace edgesplat::uplink {
namespace {

constexpr std::size_t kPoint_bytes = 10;  // 3 x 16 bits, colour, a flag
constexpr std::array<int, 4> kQualities = {85, 70, 55, 40};

std::vector<map::ColouredPoint> every_nth(const std::vector<map::ColouredPoint>& points, std::size_t n) {
  std::vector<map::ColouredPoint> kept;
  kept.reserve(points.size() / n + 1);
  for (std::size_t i = 0; i < points.size(); i += n) kept.push_back(points[i]);
  return kept;
}

/// The first of the qualities that fits, or the lowest; null where nothing would be gained.
std::shared_ptr<const map::EncodedImage> recompressed(const map::EncodedImage& image,
                                                      std::size_t most_bytes) {
  const auto pixels = io::decode_rgb8(image.bytes);
  if (!pixels) return nullptr;
  auto smaller = std::make_shared<map::EncodedImage>(image);
  smaller->format = map::EncodedImage::Format::kJpeg;
  for (const int quality : kQualities) {
    auto bytes = io::encode_jpeg(*pixels, quality);
    if (!bytes) return nullptr;
    smaller->bytes = std::move(*bytes);
    if (smaller->bytes.size() <= most_bytes) break;
  }
  if (smaller->bytes.size() >= image.bytes.size()) return nullptr;
  return smaller;
}

}  // namespace

map::Keyframe slim_keyframe(const map::Keyframe& keyframe, std::size_t target_bytes) {
  map::Keyframe slim = keyframe;
  const std::size_t image_bytes = keyframe.image ? keyframe.image->bytes.size() : 0;
  const std::size_t point_bytes = kPoint_bytes * keyframe.points_in_body.size();
  if (target_bytes == 0 || image_bytes + point_bytes <= target_bytes) return slim;
  const std::size_t for_points =
      image_bytes < target_bytes / 2 ? target_bytes - image_bytes : target_bytes / 2;
  if (point_bytes > for_points) {
    slim.points_in_body = every_nth(keyframe.points_in_body, (point_bytes + for_points - 1) / for_points);
  }
  const std::size_t for_image = target_bytes - std::min(point_bytes, for_points);
  if (image_bytes > for_image) {
    if (auto smaller = recompressed(*keyframe.image, for_image)) slim.image = std::move(smaller);
  }
  return slim;
}

}  // namespace edgesplat::uplink
