// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/warp_sums.cuh"
#include "kernels/splat/splat_one.hpp"
#include "kernels/train/adam_math.hpp"
#include "kernels/train/device_step.cuh"

namespace edgesplat::train {
namespace {

constexpr unsigned kThreads = 256;
/// Lanes that step one row together: a row is one to four times as many floats.
constexpr unsigned kLanes = ParameterRow::kLanes;
constexpr unsigned kRowsPerBlock = kThreads / kLanes;
constexpr unsigned kMostRuns = ParameterRow::kMaxStride / kLanes;
constexpr std::uint32_t kNotShown = kNoRow;

/// Where parameter k of a row lies in the cloud.
__device__ float* parameter(const splat::CloudOnDevice& cloud, std::size_t row, std::size_t k) {
  if (k < ParameterRow::kLogScale) return cloud.means_m + 3 * row + k;
  if (k < ParameterRow::kQuat) return cloud.log_scales + 3 * row + (k - ParameterRow::kLogScale);
  if (k < ParameterRow::kOpacity) return cloud.quats_xyzw + 4 * row + (k - ParameterRow::kQuat);
  if (k < ParameterRow::kSh) return cloud.opacity_logits + row;
  const auto sh_floats = static_cast<std::size_t>(3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1));
  return cloud.sh + sh_floats * row + (k - ParameterRow::kSh);
}

__device__ float rate_of(const LearningRates& rates, const AdamFactors& factors, std::size_t k) {
  if (k < ParameterRow::kLogScale) return rates.mean_m * factors.mean_share;
  if (k < ParameterRow::kQuat) return rates.log_scale;
  if (k < ParameterRow::kOpacity) return rates.quat;
  if (k < ParameterRow::kSh) return rates.opacity_logit;
  return k < ParameterRow::kSh + 3 ? rates.sh_base : rates.sh_rest;
}

/// What the regularisers add to dL by parameter k of value `value`; adds their loss to `loss`. `share` is one
/// over the rows that are shown.
__device__ float regular_gradient(const AdamOnDevice& adam, std::size_t k, float value, float share,
                                  double& loss) {
  if (k == ParameterRow::kOpacity && adam.opacity_factor > 0.0F) {
    const float opacity = 1.0F / (1.0F + std::exp(-value));
    loss += static_cast<double>(adam.opacity_factor * share * opacity);
    return adam.opacity_factor * share * opacity * (1.0F - opacity);
  }
  if (k >= ParameterRow::kLogScale && k < ParameterRow::kQuat && adam.scale_factor > 0.0F) {
    const float by_scale = adam.scale_factor * share * std::exp(value) / 3.0F;
    loss += static_cast<double>(by_scale);
    return by_scale;
  }
  return 0.0F;
}

struct Row {
  std::size_t number;
  std::uint32_t splat;  ///< that shows it, kNotShown where none does
  bool steps;
};

__device__ Row row_of(const AdamOnDevice& adam) {
  const splat::FrameOnDevice& frame = adam.reverse.frame;
  const std::size_t i = std::size_t{blockIdx.x} * kRowsPerBlock + threadIdx.x / kLanes;
  const bool complete =
      frame.counts->visible <= frame.room.visible && frame.counts->pairs <= frame.room.pairs;
  Row row{i, kNotShown, false};
  if (adam.dense) {
    if (!complete || i >= frame.cloud.count) return row;
    row.splat = adam.reverse.splat_of_row[i];
    row.steps = (frame.cloud.finite[i / core::kWarp] >> (i % core::kWarp) & 1U) != 0;
    return row;
  }
  if (!complete || i >= frame.counts->visible || !(adam.reverse.sightings[i].weight > 0.0F)) return row;
  row.number = frame.visible_rows[i];
  row.splat = static_cast<std::uint32_t>(i);
  row.steps = true;
  return row;
}

/// Sixteen lanes a row. A row whose result is not finite stays as it was.
__global__ void __launch_bounds__(kThreads) adam_kernel(AdamOnDevice adam) {
  const splat::CloudOnDevice& cloud = adam.reverse.frame.cloud;
  const std::size_t stride = adam.reverse.stride;
  const unsigned lane = threadIdx.x % kLanes;
  const Row row = row_of(adam);
  const auto used = static_cast<std::size_t>(ParameterRow::kSh) +
                    static_cast<std::size_t>(3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1));
  float after[kMostRuns] = {};
  double regular = 0.0;
  bool finite = true;
  if (row.steps) {
    const AdamFactors factors = adam_factors(adam.decay, adam.steps[row.number] + 1);
    const float share = 1.0F / static_cast<float>(*adam.reverse.shown);
    EDGESPLAT_UNROLL
    for (unsigned run = 0; run < kMostRuns; ++run) {
      const std::size_t k = run * kLanes + lane;
      if (k >= used) continue;
      const float value = *parameter(cloud, row.number, k);
      float g = 0.0F;
      if (row.splat != kNotShown) {
        g = adam.reverse.rows[row.splat * stride + k];
        g += regular_gradient(adam, k, value, share, regular);
      }
      float first = adam.first[row.number * stride + k], second = adam.second[row.number * stride + k];
      after[run] = adam_step(adam.decay, factors, rate_of(adam.rates, factors, k), g, value, first, second);
      adam.first[row.number * stride + k] = first;
      adam.second[row.number * stride + k] = second;
      finite = finite && splat::all_finite(&after[run], 1);
    }
  }
  // The quaternion's four lanes lie in the first run.
  float norm2 = 0.0F;
  for (unsigned k = ParameterRow::kQuat; k < ParameterRow::kOpacity; ++k) {
    const float q = __shfl_sync(core::kAllLanes, after[0], k, kLanes);
    norm2 += q * q;
  }
  const unsigned half = threadIdx.x % core::kWarp / kLanes;
  const unsigned all_finite = __ballot_sync(core::kAllLanes, finite ? 1 : 0) >> (half * kLanes) & 0xFFFFU;
  if (row.steps && all_finite == 0xFFFFU) {
    if (lane >= ParameterRow::kQuat && lane < ParameterRow::kOpacity) after[0] /= std::sqrt(norm2);
    EDGESPLAT_UNROLL
    for (unsigned run = 0; run < kMostRuns; ++run) {
      const std::size_t k = run * kLanes + lane;
      if (k < used) *parameter(cloud, row.number, k) = after[run];
    }
  }
  __syncwarp();
  if (row.steps && lane == 0) ++adam.steps[row.number];
  regular = core::block_sum<kThreads>(regular);
  if (threadIdx.x == 0) adam.regular_parts[blockIdx.x] = regular;
}

__global__ void gather_rows_kernel(RowsOnDevice rows) {
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  if (i >= rows.count * rows.words) return;
  const std::uint32_t from = rows.from_rows[i / rows.words];
  rows.to[i] = from == kNoRow ? 0U : rows.from[from * rows.words + i % rows.words];
}

__global__ void parameters_kernel(ReverseOnDevice reverse) {
  const splat::CloudOnDevice& cloud = reverse.frame.cloud;
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  const std::size_t j = i / reverse.stride, k = i % reverse.stride;
  if (j >= reverse.frame.room.visible || j >= reverse.frame.counts->visible) return;
  const auto used = static_cast<std::size_t>(ParameterRow::kSh) +
                    static_cast<std::size_t>(3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1));
  reverse.rows[i] = k < used ? *parameter(cloud, reverse.frame.visible_rows[j], k) : 0.0F;
}

std::size_t rows_of(const AdamOnDevice& adam) {
  const splat::FrameOnDevice& frame = adam.reverse.frame;
  return adam.dense ? frame.cloud.count : frame.room.visible;
}

}  // namespace

std::size_t regular_parts_of(const AdamOnDevice& adam) {
  return (rows_of(adam) + kRowsPerBlock - 1) / kRowsPerBlock;
}

Status gather_rows(const core::Stream& stream, const RowsOnDevice& rows) {
  return core::launch(stream, core::one_thread_each(rows.count * rows.words, kThreads), gather_rows_kernel,
                      rows);
}

Status parameters_on_device(const core::Stream& stream, const ReverseOnDevice& reverse) {
  return core::launch(stream, core::one_thread_each(reverse.frame.room.visible * reverse.stride, kThreads),
                      parameters_kernel, reverse);
}

Status adam_on_device(const core::Stream& stream, const AdamOnDevice& adam) {
  return core::launch(stream, core::one_thread_each(rows_of(adam) * kLanes, kThreads), adam_kernel, adam);
}

}  // namespace edgesplat::train
