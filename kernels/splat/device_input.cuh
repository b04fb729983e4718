// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/half.hpp"
#include "kernels/splat/device_cloud.cuh"
#include "kernels/splat/splat_one.hpp"

namespace edgesplat::splat {

/// Room for one Gaussian's parameters where they have to be made floats first.
struct InputRoom {
  float log_scale[3];
  float quat[4];
  float sh[48];
};

/// The parameters of row `row`; with_sh: its colours too, which culling does not ask for.
template <bool kHalf>
__device__ inline SplatInput input_of(const CloudOnDevice& cloud, std::size_t row, bool with_sh,
                                      InputRoom& room) {
  const int sh_floats = 3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1);
  const std::size_t first_sh = static_cast<std::size_t>(sh_floats) * row;
  const float* const mean = cloud.means_m + 3 * row;
  if constexpr (kHalf) {
    const std::uint16_t* const shape = cloud.shape_halves + 8 * row;
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k) room.log_scale[k] = core::float_of_half(shape[k]);
    EDGESPLAT_UNROLL
    for (int k = 0; k < 4; ++k) room.quat[k] = core::float_of_half(shape[4 + k]);
    for (int k = 0; with_sh && k < sh_floats; ++k)
      room.sh[k] = core::float_of_half(cloud.sh_halves[first_sh + static_cast<std::size_t>(k)]);
    return {mean, room.log_scale, room.quat, core::float_of_half(shape[3]), room.sh, cloud.sh_degree};
  } else {
    return {mean,
            cloud.log_scales + 3 * row,
            cloud.quats_xyzw + 4 * row,
            cloud.opacity_logits[row],
            cloud.sh + first_sh,
            cloud.sh_degree};
  }
}

}  // namespace edgesplat::splat
