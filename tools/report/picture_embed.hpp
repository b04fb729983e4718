// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace edgesplat::report {

/// The picture as a data URI, shrunk to at most `max_width_px` by averaging whole blocks, JPEG.
[[nodiscard]] Result<std::string> embed(const sensor::ImageRgb8& picture, int max_width_px);
[[nodiscard]] Result<std::string> embed_file(const std::filesystem::path& path, int max_width_px);

/// How well a rendered picture matches the camera's, where there is anything rendered at all.
struct RenderQuality {
  double psnr_db =
      0.0;  ///< peak signal to noise ratio over the covered pixels, all channels; 99 for equal ones
  double coverage = 0.0;  ///< share of the pixels that are covered: not pure black, the colour of nothing
};
/// Nothing where the sizes differ or nothing is covered.
[[nodiscard]] std::optional<RenderQuality> compare_render(const sensor::ImageRgb8& camera,
                                                          const sensor::ImageRgb8& render);

}  // namespace edgesplat::report
