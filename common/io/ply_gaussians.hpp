// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace edgesplat::io {

/// INRIA's 3DGS layout: x y z nx ny nz f_dc_* f_rest_* opacity scale_* rot_* as little-endian floats, rot w
/// first, f_rest channel by channel. Ids and anchors have no place in it and are left out.
[[nodiscard]] Status write_gaussians_ply(const std::filesystem::path& path,
                                         const gaussian::GaussianCloud& cloud);

/// Properties in any order, extra ones ignored, f_rest_* absent or for degree 1, 2 or 3; binary of either
/// byte order or ASCII; also PlayCanvas' compressed PLY. Ids are numbered from 0 with origin 0, rotations
/// normalised. kCorrupt names what is missing, or the first row that is not finite or has a zero rotation.
[[nodiscard]] Result<gaussian::GaussianCloud> read_gaussians_ply(const std::filesystem::path& path);
[[nodiscard]] Result<gaussian::GaussianCloud> parse_gaussians_ply(std::span<const std::byte> bytes);

}  // namespace edgesplat::io
