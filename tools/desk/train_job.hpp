// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/desk/held_out.hpp"
#include "tools/desk/training.hpp"

#include <filesystem>
#include <optional>

namespace edgesplat::desk {

/// A scene folder in, a map and its score on pictures it never saw out.
struct TrainJob {
  std::filesystem::path scene;
  std::filesystem::path out;          ///< .ply, .spz or .splat
  std::filesystem::path renders;      ///< folder for what the held-out cameras show; empty: none
  std::filesystem::path curve;        ///< CSV with the held-out quality over training time; empty: none
  std::filesystem::path lpips_model;  ///< folder of the network; empty or absent: no LPIPS
  std::size_t holdout = 8;            ///< frames 0, holdout, 2 holdout, ... are held out; 0: none
  SceneOptions pictures;
  TrainingOptions training;
};

struct TrainReport {
  std::size_t pictures = 0;  ///< trained on
  std::size_t held_out = 0;
  std::size_t images_missing = 0;
  std::size_t start_points = 0;
  bool triangulated = false;  ///< the scene had no points: they come from its pictures
  int width_px = 0;           ///< of the first picture
  int height_px = 0;
  std::uint64_t iterations = 0;
  double train_seconds = 0.0;
  std::size_t gaussians = 0;
  double peak_rss_mb = 0.0;
  std::optional<HeldOutMeans>
      held_out_means;  ///< drawn from the map as it was written; nothing: none held out
};

/// `training` ends a training that has seconds, and times its curve.
struct TrainClocks {
  const Clock& wall;
  const Clock& training;
};

/// Errors: those of reading the scene, training and writing; kInvalidArgument where the scene has no point
/// cloud and its pictures give too few points.
[[nodiscard]] Result<TrainReport> run_train_job(const TrainJob& job, const TrainClocks& clocks,
                                                const std::function<void(const TrainingProgress&)>& tell);

}  // namespace edgesplat::desk
