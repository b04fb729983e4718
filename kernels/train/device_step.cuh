// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/device_frame.cuh"
#include "kernels/train/adam_math.hpp"
#include "kernels/train/gaussian_backward.hpp"
#include "kernels/train/splat_gradient.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::train {

/// dL by the pictures, on the device. `depth_sum` and `alpha` may be nullptr: zero.
struct GradientsOfPictures {
  const float* colour;     // [H,W,3] f32
  const float* depth_sum;  // [H,W] f32
  const float* alpha;      // [H,W] f32
};

/// Reverse of a frame, as kernels see it. V and P as in FrameOnDevice.
struct ReverseOnDevice {
  splat::FrameOnDevice frame;
  splat::DevicePictures drawn;
  GradientsOfPictures by_picture;
  float* slot_sums;             // [P,kSumStride] f32, each tile's share; where the frame keeps slots
  float* sums;                  // [V,kSumStride] f32, by splat
  float* rows;                  // [V,stride] f32 as ParameterRow; those of rows not shown are not written
  Sighting* sightings;          // [V], weight 0: no pixel shows it
  double* pose_parts;           // [ceil(V/256),6] f64
  std::uint32_t* splat_of_row;  // [N] u32, all ones: not shown
  std::uint32_t* shown;         // [1] u32, rows that some pixel shows
  std::size_t stride;
};

/// Sums over the pixels by splat: tile by tile in a fixed order where the frame keeps slots, with atomic
/// additions where not (faster, and different in the last bits from run to run).
[[nodiscard]] Status blend_backward_on_device(const core::Stream& stream, const ReverseOnDevice& reverse);
/// From there to the parameters of every Gaussian that some pixel shows, and to parts of the pose's gradient.
[[nodiscard]] Status gaussian_backward_on_device(const core::Stream& stream, const ReverseOnDevice& reverse);
[[nodiscard]] std::size_t pose_parts_of(std::size_t visible);

/// Column sums of a matrix of parts [rows,columns] f64, in a fixed order. columns >= 1.
[[nodiscard]] Status sum_parts(const core::Stream& stream, const double* parts, std::size_t rows,
                               unsigned columns, double* sums);

/// Adam on the device.
struct AdamOnDevice {
  ReverseOnDevice reverse;
  AdamDecay decay;
  LearningRates rates;
  float* first;           // [N,stride] f32
  float* second;          // [N,stride] f32
  std::uint32_t* steps;   // [N] u32
  double* regular_parts;  // [ceil(rows/16)] f64, what the regularisers add to the loss
  float opacity_factor, scale_factor;
  bool dense;  ///< rows that are not shown step as well, with gradient 0
};
/// Steps every row that is shown (or all) unless the frame lacked room.
[[nodiscard]] Status adam_on_device(const core::Stream& stream, const AdamOnDevice& adam);
[[nodiscard]] std::size_t regular_parts_of(const AdamOnDevice& adam);

/// Row i of `to` takes row from_rows[i] of `from`, or zeros where that is kNoRow.
inline constexpr std::uint32_t kNoRow = 0xFFFFFFFFU;
struct RowsOnDevice {
  const std::uint32_t* from;       // [N,words] of 32 bits, whatever they hold
  const std::uint32_t* from_rows;  // [count] u32
  std::uint32_t* to;               // [count,words]
  std::size_t count;
  std::size_t words;
};
[[nodiscard]] Status gather_rows(const core::Stream& stream, const RowsOnDevice& rows);
/// Overwrites each row of gradients [V,stride] with the parameters of its Gaussian.
[[nodiscard]] Status parameters_on_device(const core::Stream& stream, const ReverseOnDevice& reverse);

}  // namespace edgesplat::train
