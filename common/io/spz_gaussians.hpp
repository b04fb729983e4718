// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace edgesplat::io {

/// SPZ versions 1 to 4 (github.com/nianticlabs/spz). Its axes are RUB; clouds have those of the INRIA files,
/// so y and z change their signs. A fourth SH band and extensions are left out. Ids are numbered from 0.
/// kCorrupt with the reason.
[[nodiscard]] Result<gaussian::GaussianCloud> read_gaussians_spz(const std::filesystem::path& path);
[[nodiscard]] Result<gaussian::GaussianCloud> parse_gaussians_spz(std::span<const std::byte> bytes);

/// Loses precision: positions to 0.25 mm (coarser for maps beyond 2 km), scales to 6 %, SH to 1/16.
/// `version` 2, 3 or 4; kInvalidArgument for others and for clouds that are not finite.
[[nodiscard]] Status write_gaussians_spz(const std::filesystem::path& path,
                                         const gaussian::GaussianCloud& cloud, std::uint32_t version = 4);

}  // namespace edgesplat::io
