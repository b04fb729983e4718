// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace edgesplat::config {
class ConfigReader;
}

namespace edgesplat::keyframe {

struct KeyframeConfig {
  /// A new keyframe after this much motion since the last one, whichever comes first...
  double translation_m = 0.4;  ///< [0.05, 10]
  double rotation_rad = 0.26;  ///< [0.02, 3.1]
  /// ...but never sooner than this.
  double min_interval_s = 0.15;  ///< [0, 10]
  double window_s = 1.0;         ///< how long a point may wait for a picture that sees it, [0, 10]
  int window_points = 400000;    ///< bound of the waiting points, oldest dropped first, [1000, 10000000]
  int occlusion_cell_px = 6;     ///< cell of the occlusion test; must exceed the gap between points, [1, 64]
  double occlusion_absolute_m = 0.15;  ///< a point this far behind the nearest surface is hidden, [0, 5]
  double occlusion_relative = 0.03;    ///< ... plus this share of its distance, [0, 1]
  double max_colour_range_m =
      60.0;  ///< farther points get no colour: calibration errors grow with range, [1, 500]
  double point_spacing_m = 0.03;  ///< keyframe points are thinned to this grid, [0, 1]; 0 = keep all
  int jpeg_quality = 92;          ///< [1, 100]
  /// Blocks of pictures that the map never gets, to compare it with: when each begins after the first
  /// picture, ascending; at most 16
  std::vector<double> hold_out_from_s;  ///< [0, 1e6]
  int hold_out_pictures = 8;            ///< a block, [1, 32]
};

/// Names, ranges and meaning of every field, for loading and printing.
void describe(config::ConfigReader& reader, KeyframeConfig& config);

}  // namespace edgesplat::keyframe
