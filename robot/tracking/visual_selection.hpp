// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/depth_cells.hpp"
#include "robot/tracking/visual_geometry.hpp"
#include "robot/tracking/visual_map.hpp"

#include <cstdint>
#include <vector>

namespace edgesplat::tracking {

/// A point to be aligned with the present picture.
struct SelectedPatch {
  std::uint32_t point;
  Reference reference;
};

/// The picture cut into cells, at most one point each, so that points spread over it.
class PictureGrid {
 public:
  PictureGrid(int width_px, int height_px);

  [[nodiscard]] int cell_of(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] int cells() const { return columns_ * rows_; }
  [[nodiscard]] int cell_px() const { return cell_px_; }
  /// Upper left pixel of a cell.
  [[nodiscard]] Eigen::Vector2i corner_px(int cell) const {
    return {cell % columns_ * cell_px_, cell / columns_ * cell_px_};
  }

 private:
  int cell_px_;
  int columns_;
  int rows_;
};

/// The points that the picture should show, the most proven of each cell, then the nearest. What the scan's
/// depth speaks against - hidden, or at an edge - is left out.
[[nodiscard]] std::vector<SelectedPatch> select_patches(const VisualMap& map, const CameraView& view,
                                                        const PictureGrid& grid, const DepthCells& depths);

}  // namespace edgesplat::tracking
