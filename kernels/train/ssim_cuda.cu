// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/warp_sums.cuh"
#include "kernels/train/device_losses.cuh"
#include "kernels/train/device_step.cuh"
#include "kernels/train/ssim_math.hpp"

namespace edgesplat::train {
namespace {

constexpr int kSide = 16;                       ///< a block has 16x16 pixels
constexpr int kWide = kSide + 2 * kSsimRadius;  ///< and looks at 26x26
constexpr unsigned kThreads = kSide * kSide;

using Wide = float[kWide][kWide];
using Rows = float[kWide][kSide];  ///< filtered along the rows

struct Place {
  int x, y;       ///< the thread's pixel in the block
  int left, top;  ///< the block's first pixel
  bool inside;
  std::size_t pixel;
};

__device__ Place place_of(const LossOnDevice& loss) {
  const int columns = (loss.width_px + kSide - 1) / kSide;
  Place at;
  at.x = static_cast<int>(threadIdx.x) % kSide;
  at.y = static_cast<int>(threadIdx.x) / kSide;
  at.left = static_cast<int>(blockIdx.x) % columns * kSide;
  at.top = static_cast<int>(blockIdx.x) / columns * kSide;
  at.inside = at.left + at.x < loss.width_px && at.top + at.y < loss.height_px;
  at.pixel = static_cast<std::size_t>(at.top + at.y) * static_cast<std::size_t>(loss.width_px) +
             static_cast<std::size_t>(at.left + at.x);
  return at;
}

/// Calls fill(wide row, wide column, pixel) for the 26x26 pixels around the block, and zero(row, column)
/// beyond the picture's edge.
template <typename Fill, typename Zero>
__device__ void over_wide(const LossOnDevice& loss, const Place& at, const Fill& fill, const Zero& zero) {
  for (int i = static_cast<int>(threadIdx.x); i < kWide * kWide; i += static_cast<int>(kThreads)) {
    const int row = i / kWide, column = i % kWide;
    const int x = at.left + column - kSsimRadius, y = at.top + row - kSsimRadius;
    if (x < 0 || y < 0 || x >= loss.width_px || y >= loss.height_px) {
      zero(row, column);
      continue;
    }
    fill(row, column,
         static_cast<std::size_t>(y) * static_cast<std::size_t>(loss.width_px) + static_cast<std::size_t>(x));
  }
}

__device__ float down_column(const Rows& rows, const Place& at) {
  float sum = 0.0F;
  EDGESPLAT_UNROLL
  for (int k = -kSsimRadius; k <= kSsimRadius; ++k)
    sum += ssim_window(k) * rows[at.y + kSsimRadius + k][at.x];
  return sum;
}

struct ForwardShared {
  Wide x, y;
  Rows mean_x, mean_y, squares, product;
};

__device__ void moments_along_rows(ForwardShared& s) {
  for (int i = static_cast<int>(threadIdx.x); i < kWide * kSide; i += static_cast<int>(kThreads)) {
    const int row = i / kSide, column = i % kSide;
    float mean_x = 0.0F, mean_y = 0.0F, squares = 0.0F, product = 0.0F;
    EDGESPLAT_UNROLL
    for (int k = -kSsimRadius; k <= kSsimRadius; ++k) {
      const float x = s.x[row][column + kSsimRadius + k], y = s.y[row][column + kSsimRadius + k];
      const float w = ssim_window(k);
      mean_x += w * x;
      mean_y += w * y;
      squares += w * (x * x + y * y);
      product += w * x * y;
    }
    s.mean_x[row][column] = mean_x;
    s.mean_y[row][column] = mean_y;
    s.squares[row][column] = squares;
    s.product[row][column] = product;
  }
}

/// Similarity of each pixel and channel, summed up with its weight; leaves its slopes times the weight.
__global__ void __launch_bounds__(kThreads) ssim_forward_kernel(LossOnDevice loss) {
  __shared__ ForwardShared s;
  const Place at = place_of(loss);
  const std::size_t plane = loss.pixels();
  float similarity = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    over_wide(
        loss, at,
        [&](int row, int column, std::size_t pixel) {
          const float w = loss.weight == nullptr ? 1.0F : loss.weight[pixel];
          s.x[row][column] = w * loss.seen[3 * pixel + c];
          s.y[row][column] = w * loss.target[3 * pixel + c];
        },
        [&](int row, int column) { s.x[row][column] = s.y[row][column] = 0.0F; });
    __syncthreads();
    moments_along_rows(s);
    __syncthreads();
    if (at.inside) {
      const SsimSlopes slopes = ssim_slopes({down_column(s.mean_x, at), down_column(s.mean_y, at),
                                             down_column(s.squares, at), down_column(s.product, at)});
      const float w = loss.weight == nullptr ? 1.0F : loss.weight[at.pixel];
      similarity += w * slopes.similarity;
      loss.slopes[c * plane + at.pixel] = w * slopes.by_x;
      loss.slopes[(3 + c) * plane + at.pixel] = w * slopes.by_squares;
      loss.slopes[(6 + c) * plane + at.pixel] = w * slopes.by_product;
    }
    __syncthreads();
  }
  const double sum = core::block_sum<kThreads>(static_cast<double>(similarity));
  if (threadIdx.x == 0) loss.parts[blockIdx.x] = sum;
}

struct BackwardShared {
  Wide slopes[3];
  Rows along[3];
};

/// Adds the gradient: each pixel takes part in the windows of its 121 neighbours.
__global__ void __launch_bounds__(kThreads) ssim_backward_kernel(LossOnDevice loss) {
  __shared__ BackwardShared s;
  const Place at = place_of(loss);
  const std::size_t plane = loss.pixels();
  const double total = 3.0 * loss.scalars[kTotalWeight];
  const float scale =
      total > 0.0 ? static_cast<float>(-static_cast<double>(loss.factors.ssim_share) / total) : 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    over_wide(
        loss, at,
        [&](int row, int column, std::size_t pixel) {
          for (std::size_t q = 0; q < 3; ++q)
            s.slopes[q][row][column] = loss.slopes[(3 * q + c) * plane + pixel];
        },
        [&](int row, int column) {
          s.slopes[0][row][column] = s.slopes[1][row][column] = s.slopes[2][row][column] = 0.0F;
        });
    __syncthreads();
    for (int i = static_cast<int>(threadIdx.x); i < 3 * kWide * kSide; i += static_cast<int>(kThreads)) {
      const int q = i / (kWide * kSide), row = i / kSide % kWide, column = i % kSide;
      float sum = 0.0F;
      EDGESPLAT_UNROLL
      for (int k = -kSsimRadius; k <= kSsimRadius; ++k)
        sum += ssim_window(k) * s.slopes[q][row][column + kSsimRadius + k];
      s.along[q][row][column] = sum;
    }
    __syncthreads();
    if (at.inside) {
      const float w = loss.weight == nullptr ? 1.0F : loss.weight[at.pixel];
      const std::size_t i = 3 * at.pixel + c;
      loss.by_colour[i] +=
          scale * w *
          (down_column(s.along[0], at) + w * (2.0F * loss.seen[i] * down_column(s.along[1], at) +
                                              loss.target[i] * down_column(s.along[2], at)));
    }
    __syncthreads();
  }
}

}  // namespace

Status ssim_on_device(const core::Stream& stream, const LossOnDevice& loss) {
  const auto columns = static_cast<unsigned>((loss.width_px + kSide - 1) / kSide);
  const auto rows = static_cast<unsigned>((loss.height_px + kSide - 1) / kSide);
  const core::LaunchShape tiles{columns * rows, kThreads};
  EDGESPLAT_TRY_STATUS(core::launch(stream, tiles, ssim_forward_kernel, loss));
  EDGESPLAT_TRY_STATUS(sum_parts(stream, loss.parts, tiles.blocks, 1, loss.scalars + kSsimSum));
  return core::launch(stream, tiles, ssim_backward_kernel, loss);
}

}  // namespace edgesplat::train
