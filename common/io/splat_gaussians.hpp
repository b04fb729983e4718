// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace edgesplat::io {

/// `.splat` (github.com/antimatter15/splat, MIT): 32 bytes a Gaussian: float x y z, float scale x y z in
/// metres, bytes r g b opacity, bytes w x y z of the rotation over -1..1. No header and no SH beyond degree
/// 0. kCorrupt where the length is no multiple of 32, or for the first Gaussian that is not finite, has a
/// negative scale or a zero rotation. A scale of 0 is read as exp(-20) m.
[[nodiscard]] Result<gaussian::GaussianCloud> read_gaussians_splat(const std::filesystem::path& path);
[[nodiscard]] Result<gaussian::GaussianCloud> parse_gaussians_splat(std::span<const std::byte> bytes);

/// In the order of the cloud; higher SH bands are left out.
[[nodiscard]] Status write_gaussians_splat(const std::filesystem::path& path,
                                           const gaussian::GaussianCloud& cloud);

}  // namespace edgesplat::io
