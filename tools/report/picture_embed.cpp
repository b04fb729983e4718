// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/picture_embed.hpp"

#include "common/io/image_file.hpp"
#include "tools/report/html_text.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::report {
namespace {

constexpr int kJpegQuality = 82;

sensor::ImageRgb8 shrink(const sensor::ImageRgb8& picture, int factor) {
  sensor::ImageRgb8 small(picture.width_px / factor, picture.height_px / factor);
  for (int y = 0; y < small.height_px; ++y) {
    for (int x = 0; x < small.width_px; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int dy = 0; dy < factor; ++dy) {
          for (int dx = 0; dx < factor; ++dx) sum += picture.pixel(x * factor + dx, y * factor + dy)[channel];
        }
        small.pixel(x, y)[channel] = static_cast<std::uint8_t>(sum / (factor * factor));
      }
    }
  }
  return small;
}

}  // namespace

Result<std::string> embed(const sensor::ImageRgb8& picture, int max_width_px) {
  const int factor = (picture.width_px + max_width_px - 1) / max_width_px;
  const bool fits = factor <= 1 || picture.height_px < factor;
  EDGESPLAT_TRY(const auto jpeg, io::encode_jpeg(fits ? picture : shrink(picture, factor), kJpegQuality));
  return data_uri("image/jpeg", jpeg);
}

Result<std::string> embed_file(const std::filesystem::path& path, int max_width_px) {
  EDGESPLAT_TRY(const sensor::ImageRgb8 picture, io::load_rgb8(path));
  return embed(picture, max_width_px);
}

std::optional<RenderQuality> compare_render(const sensor::ImageRgb8& camera,
                                            const sensor::ImageRgb8& render) {
  constexpr double kEqual_db = 99.0;
  if (camera.width_px != render.width_px || camera.height_px != render.height_px) return std::nullopt;
  double squares = 0.0;
  std::size_t covered = 0;
  for (std::size_t i = 0; i + 2 < render.values.size(); i += 3) {
    if (render.values[i] == 0 && render.values[i + 1] == 0 && render.values[i + 2] == 0) continue;
    ++covered;
    for (std::size_t channel = i; channel < i + 3; ++channel) {
      const double difference =
          static_cast<double>(camera.values[channel]) - static_cast<double>(render.values[channel]);
      squares += difference * difference;
    }
  }
  if (covered == 0) return std::nullopt;
  RenderQuality quality;
  quality.coverage = 3.0 * static_cast<double>(covered) / static_cast<double>(render.values.size());
  const double mean_square = squares / (3.0 * static_cast<double>(covered));
  quality.psnr_db =
      mean_square > 0.0 ? std::min(kEqual_db, 10.0 * std::log10(255.0 * 255.0 / mean_square)) : kEqual_db;
  return quality;
}

}  // namespace edgesplat::report
