// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project_math.hpp"

#include <bit>
#include <cstdint>

namespace edgesplat::splat {

/// Level of detail without a second map: where Gaussians are so far away that many share a pixel, some stand
/// for all (stochastic simplification, Cook 2007). One whose longest axis (1 sigma) is `size` < 1 times
/// camera.least_axis_px on the screen stays with the probability size^2 and grows by 1/size, so that those
/// that stay cover as much as all did. Which ones stay is drawn from their means: the same in every picture,
/// and one by one as the camera comes nearer.

EDGESPLAT_HOST_DEVICE inline std::uint32_t bits_of(float value) {
#ifdef __CUDA_ARCH__
  return __float_as_uint(value);
#else
  return std::bit_cast<std::uint32_t>(value);
#endif
}

/// A number in [0, 1) that belongs to a mean.
EDGESPLAT_HOST_DEVICE inline float lot_of(float x, float y, float z) {
  const std::uint32_t bits[3] = {bits_of(x), bits_of(y), bits_of(z)};
  std::uint32_t h = bits[0] * 0x9E3779B1U;
  h = ((h ^ (h >> 15U)) + bits[1]) * 0x85EBCA77U;
  h = ((h ^ (h >> 13U)) + bits[2]) * 0xC2B2AE3DU;
  h ^= h >> 16U;
  return static_cast<float>(static_cast<std::int32_t>(h >> 8U)) * 0x1p-24F;
}

/// What the axes `scale` (m) of a Gaussian with this lot are multiplied by; 0: it is left out. No branches.
template <typename T>
EDGESPLAT_HOST_DEVICE inline T growth_of(const CameraT<T>& c, const T* mean, const T* scale, T lot) {
  T p[3];
  to_camera(c, mean, p);
  const T along = c.fisheye ? std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) : p[2];
  const T distance = along > T(1e-6) ? along : T(1e-6);
  const T two = scale[0] > scale[1] ? scale[0] : scale[1];
  const T longest = two > scale[2] ? two : scale[2];
  const T focal = c.fx > c.fy ? c.fx : c.fy;
  const T share = focal * longest / (distance * c.least_axis_px);
  const T size = share < 1 ? share : T(1);
  const T larger = 1 / size;
  return lot < size * size ? larger : T(0);
}

}  // namespace edgesplat::splat
