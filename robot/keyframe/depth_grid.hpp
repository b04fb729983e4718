// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace edgesplat::keyframe {

/// Nearest depth per coarse cell of a picture: decides whether a LiDAR point can be seen by the camera or
/// hides behind something that other points lie on. Cells are wider than the gaps between points, so that a
/// wall has no holes. Single-owner; reused from picture to picture.
class DepthGrid {
 public:
  DepthGrid(int width_px, int height_px, int cell_px);

  void clear();
  /// Registers a surface point at a pixel inside the picture; z_m > 0.
  void insert(double u_px, double v_px, float z_m);
  /// Nearest depth in the 3x3 cells around the pixel; infinity where no point fell.
  [[nodiscard]] float nearest_around(double u_px, double v_px) const;
  /// True when a point at z_m would be seen: not deeper than the surface around it by more than
  /// absolute_m + relative * z_m.
  [[nodiscard]] bool visible(double u_px, double v_px, float z_m, float absolute_m, float relative) const;

 private:
  [[nodiscard]] int column(double u_px) const;
  [[nodiscard]] int row(double v_px) const;

  int cell_px_;
  int columns_;
  int rows_;
  std::vector<float> nearest_m_;  ///< [rows, columns], infinity = empty
};

}  // namespace edgesplat::keyframe
