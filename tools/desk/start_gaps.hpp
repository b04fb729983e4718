// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/io/ply_points.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "tools/desk/scene.hpp"

#include <cstddef>
#include <span>

namespace edgesplat::desk {

struct GapOptions {
  double scale = 1.0;      ///< of the training's units by the scene's
  std::size_t most = 0;    ///< Gaussians added
  float opacity = 0.1F;    ///< of theirs, 0.01..0.9
  int columns = 80;        ///< a Gaussian for every such part of a picture's width, 8..1000
  float max_alpha = 0.5F;  ///< what the start covers less is a gap, 0..1
};

/// Where pictures see something that no start point stands for - dark or shiny things, windows, whatever is
/// beyond a depth camera's reach - Gaussians of the picture's colour: as far away as a plane sweep between
/// neighbouring pictures puts them, else as far as what is next to them in the picture. `start` and the
/// result are in the training's units. Pictures are taken in turn, so that what one filled is no gap of the
/// next. Deterministic.
[[nodiscard]] Result<gaussian::GaussianCloud> gaussians_in_gaps(std::span<const ScenePicture* const> pictures,
                                                                const gaussian::GaussianCloud& start,
                                                                const GapOptions& options,
                                                                mapping::IdAllocator& ids);

}  // namespace edgesplat::desk
