// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/cuda_renderer.hpp"

#include "kernels/splat/forward_pass.cuh"

namespace edgesplat::splat {

struct CudaRenderer::State {
  State(core::VramPool& pool, bool half_precision)
      : cloud(pool, half_precision ? CloudPrecision::kHalf : CloudPrecision::kFloat),
        pass(pool, false),
        pictures(pool, "pictures") {}
  DeviceCloud cloud;
  ForwardPass pass;
  core::DeviceBuffer<float> pictures;  ///< colour, depth and alpha, one behind the other
};

CudaRenderer::CudaRenderer(core::VramPool& pool, bool half_precision)
    : state_(std::make_unique<State>(pool, half_precision)) {}
CudaRenderer::~CudaRenderer() = default;
CudaRenderer::CudaRenderer(CudaRenderer&&) noexcept = default;

Status CudaRenderer::set_cloud(const core::Stream& stream, const GaussianSpans& gaussians) {
  EDGESPLAT_TRY_STATUS(state_->cloud.set(stream, gaussians));
  return stream.synchronise();
}

Result<RenderStats> CudaRenderer::draw_on_device(const core::Stream& stream, const View& view,
                                                 const RenderOptions& options) {
  const DeviceView on_device = device_view(view, options);
  EDGESPLAT_TRY_STATUS(state_->pictures.reserve(5 * on_device.pixels()));
  float* const first = state_->pictures.data();
  const DevicePictures pictures{first, first + 3 * on_device.pixels(), first + 4 * on_device.pixels()};
  EDGESPLAT_TRY(const FrameCounts counts, state_->pass.draw(stream, state_->cloud, on_device, pictures));
  return RenderStats{counts.visible, static_cast<std::size_t>(counts.pairs), counts.not_finite};
}

Result<RenderStats> CudaRenderer::draw(const core::Stream& stream, const View& view,
                                       const RenderOptions& options, const BlendOutputs& out) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  if (out.colour.size() != 3 * pixels || out.depth_sum_m.size() != pixels || out.alpha.size() != pixels) {
    return fail(Errc::kInvalidArgument, "the output pictures do not have the view's size");
  }
  EDGESPLAT_TRY(const RenderStats stats, draw_on_device(stream, view, options));
  const float* next = state_->pictures.data();
  for (const std::span<float> picture : {out.colour, out.depth_sum_m, out.alpha}) {
    EDGESPLAT_CUDA_TRY(
        cudaMemcpyAsync(picture.data(), next, picture.size_bytes(), cudaMemcpyDeviceToHost, stream.get()));
    next += picture.size();
  }
  EDGESPLAT_TRY_STATUS(stream.synchronise());
  return stats;
}

}  // namespace edgesplat::splat
