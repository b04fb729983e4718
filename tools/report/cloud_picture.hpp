// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/ply_points.hpp"
#include "common/sensor/image.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace edgesplat::report {

/// The box that holds the points but for the outermost 0.5 % on each side of each axis; empty for no points.
[[nodiscard]] Eigen::AlignedBox3f core_extent(const io::PointCloud& cloud);

/// Points above this are left out of pictures from above, so that ceilings and crowns do not hide the rest.
struct CutAbove {
  float z_m = 0.0F;
};

/// The map seen from straight above, x to the right, y up, with the metres its edges lie at.
struct TopView {
  sensor::ImageRgb8 picture;
  double x_min_m = 0.0;
  double x_max_m = 0.0;
  double y_min_m = 0.0;
  double y_max_m = 0.0;
};
/// `longest_px`: of the picture's sides. An empty picture for no points. Points without colours are coloured
/// by height.
[[nodiscard]] TopView draw_top_view(const io::PointCloud& cloud, CutAbove cut, int longest_px);

/// The map seen obliquely from above a corner, at a distance that shows all of it.
[[nodiscard]] sensor::ImageRgb8 draw_oblique_view(const io::PointCloud& cloud, CutAbove cut, int width_px,
                                                  int height_px);

}  // namespace edgesplat::report
