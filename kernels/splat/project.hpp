// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/backend.hpp"
#include "kernels/splat/gaussian_spans.hpp"
#include "kernels/splat/view.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::splat {

/// One Gaussian on the screen, packed as the blend reads it: one line of cache.
struct alignas(64) Splat {
  float u_px, v_px;
  float conic[3];       ///< inverse 2-D covariance xx, xy, yy
  float opacity;        ///< 0..1
  float rgb[3];         ///< sRGB from SH towards the camera, >= 0
  float depth_m;        ///< z in the camera frame
  float half_width_px;  ///< of the box outside of which alpha < 1/255
  float half_height_px;
  float reach2;            ///< 2 ln(255 opacity): Mahalanobis distance squared at which alpha is 1/255
  std::uint32_t gaussian;  ///< row in the input
  std::uint32_t order;     ///< place among the visible ones in the order of rows
};

/// A splat's place in some order by its depth: positive floats sort as their bits do.
struct DepthKey {
  std::uint32_t depth_bits;
  std::uint32_t index;
};

/// Memory that one call leaves for the next.
struct ProjectScratch {
  std::vector<Splat> splats;
  std::vector<DepthKey> keys, other_keys;
};

struct Projected {
  std::vector<Splat> splats;     ///< visible ones, nearest first; ties by row
  std::uint64_t not_finite = 0;  ///< Gaussians with NaN or infinite parameters: skipped
  std::uint64_t culled = 0;      ///< behind, outside the picture or too transparent
};

/// Projects Gaussians to screen-space ellipses (project_math.hpp) with colours from SH, drops what the
/// picture does not show (alpha < 1/255 everywhere in it) and sorts by depth. The colours of what is not
/// shown are not looked at. N == 0 is valid. Backends agree to 1e-4 relative; the result does not depend on
/// the number of threads. `out` is written whole, its memory used again. Errors: kInvalidArgument (lengths),
/// kUnavailable (no such backend).
[[nodiscard]] Status project(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                             const RenderOptions& options, ProjectScratch& scratch, Projected& out);
/// The same for once.
[[nodiscard]] Result<Projected> project(core::Backend backend, const GaussianSpans& gaussians,
                                        const View& view, const RenderOptions& options);

}  // namespace edgesplat::splat
