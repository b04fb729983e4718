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
#include <string>
#include <vector>

namespace edgesplat::quality {

enum class HeldOutKind {
  kSimulated,  ///< against the clean world, from places between keyframes
  kReal,       ///< against pictures that the robot held out of mapping
};

struct HeldOutScore {
  HostTime stamp{};
  std::optional<int> block;   ///< of the picture that was held out
  double static_share = 1.0;  ///< of the pixels, those that count
  PictureScore map;
  std::optional<PictureScore> seeded;  ///< the same map before any optimisation
  PictureScore nearest;                ///< the nearest keyframe's picture in its place
  /// With the shadows of movers counting too; of pictures whose movers are masked.
  std::optional<double> psnr_with_shadows_db, psnr_nearest_with_shadows_db;
  std::string stem;  ///< of its pictures: STEM_target.png, _map.png, _seeded.png, _nearest.png, _weight.png
};

struct HeldOutScores {
  HeldOutKind kind = HeldOutKind::kSimulated;
  bool movers_masked = false;
  std::vector<HeldOutScore> views;
};

/// What should be seen from a place.
struct HeldOutTruth {
  sensor::ImageRgb8 picture;
  std::vector<float> weight;  ///< [H,W] 0..1, how much each pixel counts; empty: all of them
  /// The same with the shadows of movers counting too; empty: not asked for.
  std::vector<float> weight_with_shadows;
};

/// What is compared.
struct HeldOutInput {
  HeldOutKind kind = HeldOutKind::kSimulated;
  bool movers_masked = false;  ///< the weights leave out what can move
  std::vector<SavedKeyframe> keyframes;
  std::vector<HeldOutView> views;
  gaussian::GaussianCloud map;
  std::optional<gaussian::GaussianCloud> seeded;
  Lpips* lpips = nullptr;  ///< null: not computed
  std::function<Result<HeldOutTruth>(const HeldOutView&)> truth;
};

/// Draws the map from every view, compares, and leaves the pictures in `folder`; those of the weights (white
/// counts) only of a real run. Nothing is fitted to the picture that should be seen: where a camera changed
/// its exposure, that is an error of map and nearest keyframe alike. kIo, kCorrupt (a picture),
/// kInvalidArgument (pictures of different sizes).
[[nodiscard]] Result<HeldOutScores> score_held_out(const HeldOutInput& input,
                                                   const std::filesystem::path& folder);

/// {"kind": "simulated" or "real", "movers_masked", "views": [...], "static_share", "psnr_db", "ssim",
/// "lpips", "psnr_seeded_db", "psnr_nearest_db", "psnr_with_shadows_db", "psnr_nearest_with_shadows_db":
/// means; null where there is none}
[[nodiscard]] nlohmann::json to_json(const HeldOutScores& scores);

}  // namespace edgesplat::quality
