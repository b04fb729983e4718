// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/device_buffer.cuh"
#include "kernels/splat/gaussian_spans.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::splat {

/// The parameters of N Gaussians on the device, as kernels see them.
struct CloudOnDevice {
  float* means_m;         // [N,3] f32
  float* log_scales;      // [N,3] f32
  float* quats_xyzw;      // [N,4] f32
  float* opacity_logits;  // [N] f32
  float* sh;              // [N,(sh_degree+1)^2,3] f32
  // In half precision these two instead of the four before.
  const std::uint16_t* shape_halves;  // [N,8] f16: log scale 3, opacity logit, quaternion 4
  const std::uint16_t* sh_halves;     // [N,(sh_degree+1)^2,3] f16
  std::uint32_t* finite;      // [ceil(N/32)] u32, a bit for each Gaussian all of whose parameters are finite
  std::uint32_t* not_finite;  // [1] u32, how many are not
  std::size_t count;
  int sh_degree;
};

/// How the parameters but the means lie on the device: half precision takes 34 bytes a Gaussian at SH degree
/// 0 (124 at 3) instead of 56 (236), is for drawing only, and moves colours and outlines by some thousandths.
enum class CloudPrecision : std::uint8_t { kFloat, kHalf };

/// Gaussians that stay on the device from picture to picture. Single-owner.
class DeviceCloud {
 public:
  explicit DeviceCloud(core::VramPool& pool, CloudPrecision precision = CloudPrecision::kFloat);
  /// Puts the upload into the stream and looks which rows are finite; `gaussians` must stay until it is done.
  /// kInvalidArgument (lengths), kOutOfVram: then the cloud is empty.
  [[nodiscard]] Status set(const core::Stream& stream, const GaussianSpans& gaussians);
  /// Puts the way back into the stream; the spans have the lengths of set(). Not from half precision.
  [[nodiscard]] Status fetch(const core::Stream& stream, std::span<float> means_m,
                             std::span<float> log_scales, std::span<float> quats_xyzw,
                             std::span<float> opacity_logits, std::span<float> sh) const;
  [[nodiscard]] CloudOnDevice view();
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] int sh_degree() const { return sh_degree_; }

 private:
  [[nodiscard]] Status upload_halves(const core::Stream& stream, const GaussianSpans& gaussians);

  CloudPrecision precision_;
  core::DeviceBuffer<float> means_m_, log_scales_, quats_xyzw_, opacity_logits_, sh_;
  core::DeviceBuffer<std::uint16_t> shape_halves_, sh_halves_;
  std::vector<std::uint16_t> rounded_shape_, rounded_sh_;  ///< on their way to the device
  core::DeviceBuffer<std::uint32_t> finite_, not_finite_;
  std::size_t count_ = 0;
  int sh_degree_ = 0;
};

}  // namespace edgesplat::splat
