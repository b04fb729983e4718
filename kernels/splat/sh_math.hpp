// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

namespace edgesplat::splat {

/// Real spherical harmonics of degree 0..3 at a unit direction, in the order and with the signs of the INRIA
/// files. `basis` takes (degree + 1)^2 values.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void sh_basis(int degree, T x, T y, T z, T* basis) {
  basis[0] = T(0.28209479177387814);
  if (degree < 1) return;
  basis[1] = T(-0.4886025119029199) * y;
  basis[2] = T(0.4886025119029199) * z;
  basis[3] = T(-0.4886025119029199) * x;
  if (degree < 2) return;
  const T xx = x * x, yy = y * y, zz = z * z;
  basis[4] = T(1.0925484305920792) * x * y;
  basis[5] = T(-1.0925484305920792) * y * z;
  basis[6] = T(0.31539156525252005) * (2 * zz - xx - yy);
  basis[7] = T(-1.0925484305920792) * x * z;
  basis[8] = T(0.5462742152960396) * (xx - yy);
  if (degree < 3) return;
  basis[9] = T(-0.5900435899266435) * y * (3 * xx - yy);
  basis[10] = T(2.890611442640554) * x * y * z;
  basis[11] = T(-0.4570457994644658) * y * (4 * zz - xx - yy);
  basis[12] = T(0.3731763325901154) * z * (2 * zz - 3 * xx - 3 * yy);
  basis[13] = T(-0.4570457994644658) * x * (4 * zz - xx - yy);
  basis[14] = T(1.445305721320277) * z * (xx - yy);
  basis[15] = T(-0.5900435899266435) * x * (xx - 3 * yy);
}

}  // namespace edgesplat::splat
