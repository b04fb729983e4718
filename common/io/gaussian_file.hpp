// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace edgesplat::io {

enum class GaussianFormat { kPly, kSpz, kSplat };
/// "ply", "spz", "splat".
[[nodiscard]] std::string_view to_string(GaussianFormat format);

/// By the name's ending (.ply, .spz or .splat, in any case); kInvalidArgument names these for another one.
[[nodiscard]] Result<GaussianFormat> gaussian_format_of(const std::filesystem::path& path);

/// A map of any of the formats; see their headers.
[[nodiscard]] Result<gaussian::GaussianCloud> read_gaussians(const std::filesystem::path& path);
/// `spz_version` counts for .spz alone.
[[nodiscard]] Status write_gaussians(const std::filesystem::path& path, const gaussian::GaussianCloud& cloud,
                                     std::uint32_t spz_version = 4);

}  // namespace edgesplat::io
