// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/device_cloud.cuh"

#include "kernels/core/launch.cuh"
#include "kernels/splat/splat_one.hpp"

namespace edgesplat::splat {
namespace {

__global__ void find_finite(CloudOnDevice cloud) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  bool finite = false;
  if (i < cloud.count) {
    const int sh_floats = 3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1);
    finite = all_finite(cloud.means_m + 3 * i, 3) && all_finite(cloud.log_scales + 3 * i, 3) &&
             all_finite(cloud.quats_xyzw + 4 * i, 4) && all_finite(cloud.opacity_logits + i, 1) &&
             all_finite(cloud.sh + static_cast<std::size_t>(sh_floats) * i, sh_floats);
  }
  const unsigned word = __ballot_sync(core::kAllLanes, finite);
  const unsigned wrong = __ballot_sync(core::kAllLanes, i < cloud.count && !finite);
  if (threadIdx.x % core::kWarp != 0 || i >= cloud.count) return;
  cloud.finite[i / core::kWarp] = word;
  if (wrong != 0) atomicAdd(cloud.not_finite, static_cast<unsigned>(__popc(wrong)));
}

}  // namespace

DeviceCloud::DeviceCloud(core::VramPool& pool)
    : means_m_(pool, "the Gaussians' means"),
      log_scales_(pool, "the Gaussians' scales"),
      quats_xyzw_(pool, "the Gaussians' rotations"),
      opacity_logits_(pool, "the Gaussians' opacities"),
      sh_(pool, "the Gaussians' colours"),
      finite_(pool, "the Gaussians' state"),
      not_finite_(pool, "the Gaussians' state") {}

Status DeviceCloud::set(const core::Stream& stream, const GaussianSpans& gaussians) {
  count_ = 0;
  if (!gaussians.consistent()) {
    return fail(Errc::kInvalidArgument, "Gaussian arrays of different lengths, or an SH degree outside 0..3");
  }
  sh_degree_ = gaussians.sh_degree;
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.means_m, means_m_));
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.log_scales, log_scales_));
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.quats_xyzw, quats_xyzw_));
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.opacity_logits, opacity_logits_));
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.sh, sh_));
  EDGESPLAT_TRY_STATUS(finite_.reserve((gaussians.size() + core::kWarp - 1) / core::kWarp));
  EDGESPLAT_TRY_STATUS(not_finite_.reserve(1));
  EDGESPLAT_TRY_STATUS(core::fill_bytes(stream, not_finite_, 0, 1));
  count_ = gaussians.size();
  return core::launch(stream, core::one_thread_each(count_), find_finite, view());
}

Status DeviceCloud::fetch(const core::Stream& stream, std::span<float> means_m, std::span<float> log_scales,
                          std::span<float> quats_xyzw, std::span<float> opacity_logits,
                          std::span<float> sh) const {
  EDGESPLAT_TRY_STATUS(core::download(stream, means_m_, means_m));
  EDGESPLAT_TRY_STATUS(core::download(stream, log_scales_, log_scales));
  EDGESPLAT_TRY_STATUS(core::download(stream, quats_xyzw_, quats_xyzw));
  EDGESPLAT_TRY_STATUS(core::download(stream, opacity_logits_, opacity_logits));
  return core::download(stream, sh_, sh);
}

CloudOnDevice DeviceCloud::view() {
  return {means_m_.data(), log_scales_.data(), quats_xyzw_.data(), opacity_logits_.data(),
          sh_.data(),      finite_.data(),     not_finite_.data(), count_,
          sh_degree_};
}

}  // namespace edgesplat::splat
