// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/time/clock.hpp"
#include "tools/desk/scene.hpp"
#include "tools/quality/lpips.hpp"

#include <filesystem>
#include <optional>
#include <span>

namespace edgesplat::desk {

/// Means over held-out pictures.
struct HeldOutMeans {
  double psnr_db = 0.0;
  double ssim = 0.0;
  std::optional<double> lpips;  ///< nothing without the network
  double render_ms = 0.0;
};

/// Draws the pictures' cameras from the map and compares with the pictures, pixels that undistorting did not
/// find left out. `lpips` may be null. `renders`: folder for what was drawn beside the real pictures; empty:
/// none. kInvalidArgument without a picture, kIo.
[[nodiscard]] Result<HeldOutMeans> score_pictures(const gaussian::GaussianCloud& map,
                                                  std::span<const ScenePicture* const> pictures,
                                                  quality::Lpips* lpips, const std::filesystem::path& renders,
                                                  const Clock& clock);

}  // namespace edgesplat::desk
