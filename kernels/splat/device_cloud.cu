// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/device_cloud.cuh"

#include "kernels/core/launch.cuh"
#include "kernels/splat/device_input.cuh"

#include <algorithm>

namespace edgesplat::splat {
namespace {

template <bool kHalf>
__global__ void find_finite(CloudOnDevice cloud) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  bool finite = false;
  if (i < cloud.count) {
    InputRoom room;
    const SplatInput in = input_of<kHalf>(cloud, i, true, room);
    const int sh_floats = 3 * (in.sh_degree + 1) * (in.sh_degree + 1);
    finite = all_finite(in.mean, 3) && all_finite(in.log_scale, 3) && all_finite(in.quat, 4) &&
             all_finite(&in.opacity_logit, 1) && all_finite(in.sh, sh_floats);
  }
  const unsigned word = __ballot_sync(core::kAllLanes, finite);
  const unsigned wrong = __ballot_sync(core::kAllLanes, i < cloud.count && !finite);
  if (threadIdx.x % core::kWarp != 0 || i >= cloud.count) return;
  cloud.finite[i / core::kWarp] = word;
  if (wrong != 0) atomicAdd(cloud.not_finite, static_cast<unsigned>(__popc(wrong)));
}

}  // namespace

DeviceCloud::DeviceCloud(core::VramPool& pool, CloudPrecision precision)
    : precision_(precision),
      means_m_(pool, "the Gaussians' means"),
      log_scales_(pool, "the Gaussians' scales"),
      quats_xyzw_(pool, "the Gaussians' rotations"),
      opacity_logits_(pool, "the Gaussians' opacities"),
      sh_(pool, "the Gaussians' colours"),
      shape_halves_(pool, "the Gaussians' shapes"),
      sh_halves_(pool, "the Gaussians' colours"),
      finite_(pool, "the Gaussians' state"),
      not_finite_(pool, "the Gaussians' state") {}

Status DeviceCloud::set(const core::Stream& stream, const GaussianSpans& gaussians) {
  count_ = 0;
  if (!gaussians.consistent()) {
    return fail(Errc::kInvalidArgument, "Gaussian arrays of different lengths, or an SH degree outside 0..3");
  }
  sh_degree_ = gaussians.sh_degree;
  EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.means_m, means_m_));
  if (precision_ == CloudPrecision::kHalf) {
    EDGESPLAT_TRY_STATUS(upload_halves(stream, gaussians));
  } else {
    EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.log_scales, log_scales_));
    EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.quats_xyzw, quats_xyzw_));
    EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.opacity_logits, opacity_logits_));
    EDGESPLAT_TRY_STATUS(core::upload(stream, gaussians.sh, sh_));
  }
  EDGESPLAT_TRY_STATUS(finite_.reserve((gaussians.size() + core::kWarp - 1) / core::kWarp));
  EDGESPLAT_TRY_STATUS(not_finite_.reserve(1));
  EDGESPLAT_TRY_STATUS(core::fill_bytes(stream, not_finite_, 0, 1));
  count_ = gaussians.size();
  const auto find = precision_ == CloudPrecision::kHalf ? &find_finite<true> : &find_finite<false>;
  return core::launch(stream, core::one_thread_each(count_), find, view());
}

Status DeviceCloud::upload_halves(const core::Stream& stream, const GaussianSpans& gaussians) {
  rounded_shape_.resize(8 * gaussians.size());
  rounded_sh_.resize(gaussians.sh.size());
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    std::uint16_t* const shape = &rounded_shape_[8 * i];
    for (std::size_t k = 0; k < 3; ++k) shape[k] = core::half_of_float(gaussians.log_scales[3 * i + k]);
    shape[3] = core::half_of_float(gaussians.opacity_logits[i]);
    for (std::size_t k = 0; k < 4; ++k) shape[4 + k] = core::half_of_float(gaussians.quats_xyzw[4 * i + k]);
  }
  std::transform(gaussians.sh.begin(), gaussians.sh.end(), rounded_sh_.begin(), core::half_of_float);
  EDGESPLAT_TRY_STATUS(core::upload(stream, std::span<const std::uint16_t>(rounded_shape_), shape_halves_));
  return core::upload(stream, std::span<const std::uint16_t>(rounded_sh_), sh_halves_);
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
  return {means_m_.data(),    log_scales_.data(),
          quats_xyzw_.data(), opacity_logits_.data(),
          sh_.data(),         shape_halves_.data(),
          sh_halves_.data(),  finite_.data(),
          not_finite_.data(), count_,
          sh_degree_};
}

}  // namespace edgesplat::splat
