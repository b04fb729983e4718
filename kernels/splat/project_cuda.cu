// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/forward_pass.cuh"
#include "kernels/splat/project_backends.hpp"

#include <vector>

namespace edgesplat::splat {

Result<Projected> project_cuda(const GaussianSpans& gaussians, const View& view,
                               const RenderOptions& options) {
  EDGESPLAT_TRY(const core::Stream stream, core::Stream::create());
  EDGESPLAT_TRY(const std::size_t budget_bytes, core::share_of_free_vram(0.9));
  core::VramPool pool(budget_bytes);
  DeviceCloud cloud(pool);
  ForwardPass pass(pool, false);
  const DeviceView on_device = device_view(view, options);
  core::DeviceBuffer<float> pictures(pool, "pictures");
  EDGESPLAT_TRY_STATUS(pictures.reserve(5 * on_device.pixels()));
  EDGESPLAT_TRY_STATUS(cloud.set(stream, gaussians));
  float* const first = pictures.data();
  EDGESPLAT_TRY(const FrameCounts counts,
                pass.draw(stream, cloud, on_device,
                          {first, first + 3 * on_device.pixels(), first + 4 * on_device.pixels()}));
  std::vector<Splat> splats(counts.visible);
  std::vector<std::uint32_t> order(counts.visible);
  if (counts.visible > 0) {
    EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(splats.data(), pass.frame().splats, splats.size() * sizeof(Splat),
                                       cudaMemcpyDeviceToHost, stream.get()));
    EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(order.data(), pass.frame().by_depth,
                                       order.size() * sizeof(std::uint32_t), cudaMemcpyDeviceToHost,
                                       stream.get()));
  }
  EDGESPLAT_TRY_STATUS(stream.synchronise());
  Projected out;
  out.splats.reserve(splats.size());
  for (const std::uint32_t splat : order) out.splats.push_back(splats[splat]);
  out.not_finite = counts.not_finite;
  out.culled = gaussians.size() - splats.size() - counts.not_finite;
  return out;
}

}  // namespace edgesplat::splat
