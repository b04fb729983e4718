// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// First CUDA kernel of the project. It compiles for sm_87, sm_89 and sm_90 and shares its maths with the CPU
// backend (splat_one.hpp), whose tests cover it; it has never run on a GPU.
#include "kernels/core/device_buffer.cuh"
#include "kernels/splat/depth_order.hpp"
#include "kernels/splat/project_backends.hpp"
#include "kernels/splat/splat_one.hpp"

namespace edgesplat::splat {
namespace {

constexpr unsigned kThreads = 256;

/// What one launch reads and writes; passed by value.
struct ProjectLaunch {
  const float* means;           // [N,3] f32
  const float* log_scales;      // [N,3] f32
  const float* quats_xyzw;      // [N,4] f32
  const float* opacity_logits;  // [N] f32
  const float* sh;              // [N,(sh_degree+1)^2,3] f32
  Splat* splats;                // [N]
  SplatOutcome* outcomes;       // [N]
  std::size_t count;
  int sh_degree;
  CameraT<float> camera;
  float position[3];
  float near_m;
  float low_pass_px2;
  float width_px;
  float height_px;
};

__global__ void project_kernel(ProjectLaunch launch) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i >= launch.count) return;
  const auto bands = static_cast<std::size_t>(launch.sh_degree + 1);
  const SplatInput in{launch.means + 3 * i,     launch.log_scales + 3 * i,         launch.quats_xyzw + 4 * i,
                      launch.opacity_logits[i], launch.sh + 3 * bands * bands * i, launch.sh_degree};
  Splat splat{};
  splat.gaussian = static_cast<std::uint32_t>(i);
  launch.outcomes[i] = splat_one(in, launch.camera, launch.position, launch.near_m, launch.low_pass_px2,
                                 launch.width_px, launch.height_px, splat);
  launch.splats[i] = splat;
}

ProjectLaunch launch_for(const GaussianSpans& gaussians, const View& view, const RenderOptions& options) {
  ProjectLaunch launch{};
  launch.count = gaussians.size();
  launch.sh_degree = gaussians.sh_degree;
  launch.camera = camera_of(view);
  for (std::size_t i = 0; i < 3; ++i) launch.position[i] = view.position[i];
  launch.near_m = options.near_m;
  launch.low_pass_px2 = options.low_pass_px2;
  launch.width_px = static_cast<float>(view.width_px);
  launch.height_px = static_cast<float>(view.height_px);
  return launch;
}

/// Visible splats in the order of their rows, then by depth, as the CPU backend does it.
Projected collect(const std::vector<Splat>& splats, const std::vector<SplatOutcome>& outcomes) {
  Projected out;
  std::vector<Splat> visible;
  for (std::size_t i = 0; i < splats.size(); ++i) {
    if (outcomes[i] == SplatOutcome::kVisible) visible.push_back(splats[i]);
    if (outcomes[i] == SplatOutcome::kCulled) ++out.culled;
    if (outcomes[i] == SplatOutcome::kNotFinite) ++out.not_finite;
  }
  out.splats = sorted_by_depth(visible);
  return out;
}

}  // namespace

Result<Projected> project_cuda(const GaussianSpans& gaussians, const View& view,
                               const RenderOptions& options) {
  ProjectLaunch launch = launch_for(gaussians, view, options);
  if (launch.count == 0) return Projected{};
  EDGESPLAT_TRY(const core::Stream stream, core::Stream::create());
  using Floats = core::DeviceBuffer<float>;
  EDGESPLAT_TRY(const Floats means, Floats::copy_of(stream, gaussians.means_m));
  EDGESPLAT_TRY(const Floats log_scales, Floats::copy_of(stream, gaussians.log_scales));
  EDGESPLAT_TRY(const Floats quats, Floats::copy_of(stream, gaussians.quats_xyzw));
  EDGESPLAT_TRY(const Floats logits, Floats::copy_of(stream, gaussians.opacity_logits));
  EDGESPLAT_TRY(const Floats sh, Floats::copy_of(stream, gaussians.sh));
  EDGESPLAT_TRY(auto splats, core::DeviceBuffer<Splat>::create(stream, launch.count));
  EDGESPLAT_TRY(auto outcomes, core::DeviceBuffer<SplatOutcome>::create(stream, launch.count));
  launch.means = means.data();
  launch.log_scales = log_scales.data();
  launch.quats_xyzw = quats.data();
  launch.opacity_logits = logits.data();
  launch.sh = sh.data();
  launch.splats = splats.data();
  launch.outcomes = outcomes.data();
  const auto blocks = static_cast<unsigned>((launch.count + kThreads - 1) / kThreads);
  project_kernel<<<blocks, kThreads, 0, stream.get()>>>(launch);
  EDGESPLAT_CUDA_TRY(cudaGetLastError());
  EDGESPLAT_TRY(const std::vector<Splat> all, splats.start_download());
  EDGESPLAT_TRY(const std::vector<SplatOutcome> reached, outcomes.start_download());
  EDGESPLAT_TRY_STATUS(stream.synchronise());
  return collect(all, reached);
}

}  // namespace edgesplat::splat
