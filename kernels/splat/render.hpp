// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend.hpp"
#include "kernels/splat/project.hpp"
#include "kernels/splat/tile_lists.hpp"

#include <memory>

namespace edgesplat::splat {

struct RenderStats {
  std::size_t visible = 0;
  std::size_t tile_pairs = 0;
  std::uint64_t not_finite = 0;  ///< Gaussians skipped because a parameter is NaN or infinite
};

/// Draws Gaussians: project, sort, tile, blend (3D Gaussian Splatting, Kerbl 2023). Outputs are written
/// whole; an empty cloud gives the background. Errors: kInvalidArgument (lengths), kUnavailable (backend).
/// kOutOfVram. Thread-safe: no state, so on a GPU every call brings the Gaussians there: see Renderer.
[[nodiscard]] Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians,
                                         const View& view, const RenderOptions& options,
                                         const BlendOutputs& out);

/// What the CPU leaves of one picture: memory for the next, and what blend_backward asks for.
struct RenderScratch {
  ProjectScratch project;
  Projected projected;
  TileListsScratch tiles_scratch;
  TileLists tiles;
};
/// render() on the CPU.
[[nodiscard]] Result<RenderStats> render_cpu(const GaussianSpans& gaussians, const View& view,
                                             const RenderOptions& options, const BlendOutputs& out,
                                             RenderScratch& scratch);

/// Draws the same Gaussians from many places: on a GPU they stay there. Single-owner.
class Renderer {
 public:
  /// kUnavailable where the backend cannot run here.
  static Result<Renderer> create(core::Backend backend);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// What is drawn from now on. The arrays must stay as they are until the next set_cloud(): the CPU reads
  /// them there. kInvalidArgument (lengths) here or when drawing, kOutOfVram.
  Status set_cloud(const GaussianSpans& gaussians);
  /// As render().
  [[nodiscard]] Result<RenderStats> draw(const View& view, const RenderOptions& options,
                                         const BlendOutputs& out);

 private:
  class Drawing;
  explicit Renderer(std::unique_ptr<Drawing> drawing);
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace edgesplat::splat
