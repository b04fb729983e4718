// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "tools/quality/held_out_views.hpp"
#include "tools/quality/picture_score.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::quality {

struct HeldOutScore {
  HostTime stamp{};
  PictureScore map;
  std::optional<PictureScore> seeded;  ///< the same map before any optimisation
  PictureScore nearest;                ///< the nearest keyframe's picture in its place
  std::string stem;  ///< of its pictures: STEM_target.png, _map.png, _seeded.png, _nearest.png
};

/// What is compared.
struct HeldOutInput {
  std::vector<SavedKeyframe> keyframes;
  std::vector<HeldOutView> views;
  gaussian::GaussianCloud map;
  std::optional<gaussian::GaussianCloud> seeded;
  std::vector<float> seen;  ///< [H,W] pixels that the undistorted camera sees
  Lpips* lpips = nullptr;   ///< null: not computed
  /// The picture that should be seen from there.
  std::function<Result<sensor::ImageRgb8>(const HeldOutView&)> target;
};

/// Draws the map from every view, compares, and leaves the pictures in `folder`. kIo, kCorrupt (a keyframe's
/// picture).
[[nodiscard]] Result<std::vector<HeldOutScore>> score_held_out(const HeldOutInput& input,
                                                               const std::filesystem::path& folder);

/// {"views": [...], "psnr_db", "ssim", "lpips", "psnr_seeded_db", "psnr_nearest_db": means; null where there
/// is none}
[[nodiscard]] nlohmann::json to_json(std::span<const HeldOutScore> scores);

}  // namespace edgesplat::quality
