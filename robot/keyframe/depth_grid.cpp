// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/depth_grid.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::keyframe {

namespace {
constexpr float kEmpty = std::numeric_limits<float>::infinity();
}

DepthGrid::DepthGrid(int width_px, int height_px, int cell_px)
    : cell_px_(cell_px),
      columns_((width_px + cell_px - 1) / cell_px),
      rows_((height_px + cell_px - 1) / cell_px) {
  EDGESPLAT_CHECK(width_px > 0 && height_px > 0 && cell_px > 0, "a picture and a cell have a size");
  nearest_m_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kEmpty);
}

void DepthGrid::clear() {
  std::fill(nearest_m_.begin(), nearest_m_.end(), kEmpty);
}

int DepthGrid::column(double u_px) const {
  return std::clamp(static_cast<int>(std::floor((u_px + 0.5) / cell_px_)), 0, columns_ - 1);
}

int DepthGrid::row(double v_px) const {
  return std::clamp(static_cast<int>(std::floor((v_px + 0.5) / cell_px_)), 0, rows_ - 1);
}

void DepthGrid::insert(double u_px, double v_px, float z_m) {
  float& cell = nearest_m_[static_cast<std::size_t>(row(v_px) * columns_ + column(u_px))];
  cell = std::min(cell, z_m);
}

float DepthGrid::nearest_around(double u_px, double v_px) const {
  const int x = column(u_px);
  const int y = row(v_px);
  float nearest = kEmpty;
  for (int r = std::max(0, y - 1); r <= std::min(rows_ - 1, y + 1); ++r) {
    for (int c = std::max(0, x - 1); c <= std::min(columns_ - 1, x + 1); ++c) {
      nearest = std::min(nearest, nearest_m_[static_cast<std::size_t>(r * columns_ + c)]);
    }
  }
  return nearest;
}

bool DepthGrid::visible(double u_px, double v_px, float z_m, float absolute_m, float relative) const {
  return z_m <= nearest_around(u_px, v_px) + absolute_m + relative * z_m;
}

}  // namespace edgesplat::keyframe
