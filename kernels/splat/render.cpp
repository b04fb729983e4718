// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"

#include "kernels/splat/tile_lists.hpp"

#ifdef EDGESPLAT_WITH_CUDA
#include "kernels/splat/cuda_renderer.hpp"
#endif

namespace edgesplat::splat {
namespace {

bool fits(const BlendOutputs& out, const View& view) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  return out.colour.size() == 3 * pixels && out.depth_sum_m.size() == pixels && out.alpha.size() == pixels;
}

}  // namespace

Result<RenderStats> render_cpu(const GaussianSpans& gaussians, const View& view, const RenderOptions& options,
                               const BlendOutputs& out, RenderScratch& scratch) {
  if (!fits(out, view))
    return fail(Errc::kInvalidArgument, "the output pictures do not have the view's size");
  Projected& projected = scratch.projected;
  EDGESPLAT_TRY_STATUS(project(core::Backend::kCpu, gaussians, view, options, scratch.project, projected));
  make_tile_lists(projected.splats, view.width_px, view.height_px, scratch.tiles_scratch, scratch.tiles);
  blend(projected.splats, scratch.tiles, view, options, out);
  return RenderStats{projected.splats.size(), scratch.tiles.entries.size(), projected.not_finite};
}

/// One implementation a backend.
class Renderer::Drawing {
 public:
  virtual ~Drawing() = default;
  virtual Status set_cloud(const GaussianSpans& gaussians) = 0;
  virtual Result<RenderStats> draw(const View& view, const RenderOptions& options,
                                   const BlendOutputs& out) = 0;
};

namespace {

template <typename Drawing>
class DrawingOnCpu : public Drawing {
 public:
  Status set_cloud(const GaussianSpans& gaussians) override {
    gaussians_ = gaussians;
    return {};
  }
  Result<RenderStats> draw(const View& view, const RenderOptions& options, const BlendOutputs& out) override {
    return render_cpu(gaussians_, view, options, out, scratch_);
  }

 private:
  GaussianSpans gaussians_;
  RenderScratch scratch_;
};

#ifdef EDGESPLAT_WITH_CUDA
/// Of what is free when the renderer is made; the rest is for whoever else uses the GPU.
constexpr double kVramShare = 0.6;

template <typename Drawing>
class DrawingOnCuda : public Drawing {
 public:
  DrawingOnCuda(core::Stream stream, std::size_t budget_bytes)
      : stream_(std::move(stream)), pool_(budget_bytes), renderer_(pool_) {}
  Status set_cloud(const GaussianSpans& gaussians) override {
    return renderer_.set_cloud(stream_, gaussians);
  }
  Result<RenderStats> draw(const View& view, const RenderOptions& options, const BlendOutputs& out) override {
    return renderer_.draw(stream_, view, options, out);
  }

 private:
  core::Stream stream_;
  core::VramPool pool_;
  CudaRenderer renderer_;
};
#endif

}  // namespace

Renderer::Renderer(std::unique_ptr<Drawing> drawing) : drawing_(std::move(drawing)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result<Renderer> Renderer::create(core::Backend backend) {
  if (backend == core::Backend::kCpu) return Renderer(std::make_unique<DrawingOnCpu<Drawing>>());
#ifdef EDGESPLAT_WITH_CUDA
  EDGESPLAT_TRY(core::Stream stream, core::Stream::create());
  EDGESPLAT_TRY(const std::size_t budget_bytes, core::share_of_free_vram(kVramShare));
  return Renderer(std::make_unique<DrawingOnCuda<Drawing>>(std::move(stream), budget_bytes));
#else
  return fail(Errc::kUnavailable, "this build has no CUDA backend: configure with the preset cuda");
#endif
}

Status Renderer::set_cloud(const GaussianSpans& gaussians) {
  return drawing_->set_cloud(gaussians);
}

Result<RenderStats> Renderer::draw(const View& view, const RenderOptions& options, const BlendOutputs& out) {
  return drawing_->draw(view, options, out);
}

Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                           const RenderOptions& options, const BlendOutputs& out) {
  if (backend == core::Backend::kCpu) {
    RenderScratch scratch;
    return render_cpu(gaussians, view, options, out, scratch);
  }
  EDGESPLAT_TRY(Renderer renderer, Renderer::create(backend));
  EDGESPLAT_TRY_STATUS(renderer.set_cloud(gaussians));
  return renderer.draw(view, options, out);
}

}  // namespace edgesplat::splat
