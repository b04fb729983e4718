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

/// Peak signal to noise ratio of two pictures of the same size, over all pixels and channels; nothing where
/// the sizes differ, 99 dB for equal pictures.
[[nodiscard]] std::optional<double> psnr_db(const sensor::ImageRgb8& a, const sensor::ImageRgb8& b);

}  // namespace edgesplat::report
