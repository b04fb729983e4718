// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/gaussian_backward.hpp"

#include "common/base/check.hpp"
#include "kernels/splat/splat_one.hpp"
#include "kernels/train/covariance_backward_math.hpp"
#include "kernels/train/project_backward_math.hpp"
#include "kernels/train/sh_backward_math.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::train {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr auto kUnseen = std::numeric_limits<std::uint32_t>::max();

using Pose = std::array<double, 6>;

struct Source {
  const splat::GaussianSpans& gaussians;
  const splat::View& view;
  splat::CameraT<float> camera;
};

/// One Gaussian: fills `out` (a ParameterRow) and adds to the pose's gradient. False, and nothing of use in
/// `out`, where a value is not finite.
bool reverse_one(const Source& source, const splat::Splat& s, const SplatGradient<float>& by, float* out,
                 Pose& pose) {
  const splat::GaussianSpans& g = source.gaussians;
  const std::size_t i = s.gaussian;
  const float* mean = &g.means_m[3 * i];
  float cov3d[6];
  splat::covariance3d(&g.quats_xyzw[4 * i], &g.log_scales[3 * i], cov3d);
  ProjectBackward<float> projected;
  project_backward(source.camera, mean, cov3d, s.conic, by, projected);
  covariance3d_backward(&g.quats_xyzw[4 * i], &g.log_scales[3 * i], projected.cov3d,
                        out + ParameterRow::kQuat, out + ParameterRow::kLogScale);
  const float* position = source.view.position.data();
  const float offset[3] = {mean[0] - position[0], mean[1] - position[1], mean[2] - position[2]};
  float by_offset[3], by_position[3], turn[3];
  colour_backward(g.sh_degree, offset, &g.sh[g.sh_floats_each() * i], s.rgb, by.rgb, out + ParameterRow::kSh,
                  by_offset);
  for (std::size_t k = 0; k < 3; ++k) {
    out[ParameterRow::kMean + k] = projected.mean[k] + by_offset[k];
    by_position[k] = -by_offset[k];
  }
  out[ParameterRow::kOpacity] = by.opacity * s.opacity * (1.0F - s.opacity);
  if (!splat::all_finite(out, static_cast<int>(ParameterRow::size(g.sh_degree))) ||
      !splat::all_finite(projected.pose, 6)) {
    return false;
  }
  // The camera's position -R^T t goes with the pose as well: dr turns it by position x dr, dt moves it by
  // -R^T dt.
  cross(by_position, position, turn);
  const float* r = source.camera.rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    const float along = r[3 * k] * by_offset[0] + r[3 * k + 1] * by_offset[1] + r[3 * k + 2] * by_offset[2];
    pose[k] += static_cast<double>(projected.pose[k] + turn[k]);
    pose[3 + k] += static_cast<double>(projected.pose[3 + k] + along);
  }
  return true;
}

/// Which splat shows each row of the cloud, and the rows that one does.
struct Index {
  std::vector<std::uint32_t> rows;    ///< ascending
  std::vector<std::uint32_t> splats;  ///< [rows]
};

Index by_row(std::span<const splat::Splat> splats, std::size_t gaussians) {
  std::vector<std::uint32_t> splat_of(gaussians, kUnseen);
  for (std::size_t i = 0; i < splats.size(); ++i)
    splat_of[splats[i].gaussian] = static_cast<std::uint32_t>(i);
  Index index;
  index.rows.reserve(splats.size());
  index.splats.reserve(splats.size());
  for (std::size_t row = 0; row < gaussians; ++row) {
    if (splat_of[row] == kUnseen) continue;
    index.rows.push_back(static_cast<std::uint32_t>(row));
    index.splats.push_back(splat_of[row]);
  }
  return index;
}

void reverse_block(const Source& source, std::span<const splat::Splat> splats,
                   std::span<const SplatBackward> by_splat, const Index& index, std::size_t block,
                   GaussianGradients& out, Pose& pose) {
  const std::size_t last = std::min(index.rows.size(), (block + 1) * kBlock);
  for (std::size_t i = block * kBlock; i < last; ++i) {
    const std::size_t k = index.splats[i];
    const splat::Splat& s = splats[k];
    const SplatGradient<float>& by = by_splat[k].gradient;
    float* values = &out.values[i * out.stride];
    if (!reverse_one(source, s, by, values, pose)) std::fill_n(values, out.stride, 0.0F);
    out.sightings[i] = {std::hypot(by.u, by.v), by_splat[k].weight,
                        std::max(s.half_width_px, s.half_height_px)};
  }
}

}  // namespace

GaussianGradients gaussian_backward(const splat::GaussianSpans& gaussians, const splat::View& view,
                                    std::span<const splat::Splat> splats,
                                    std::span<const SplatBackward> by_splat) {
  EDGESPLAT_CHECK(gaussians.consistent() && splats.size() == by_splat.size(), "a gradient for every splat");
  GaussianGradients out;
  out.stride = ParameterRow::stride(gaussians.sh_degree);
  Index index = by_row(splats, gaussians.size());
  out.values.resize(index.rows.size() * out.stride);
  out.sightings.resize(index.rows.size());
  const std::size_t blocks = (index.rows.size() + kBlock - 1) / kBlock;
  std::vector<Pose> poses(blocks, Pose{});
  const Source source{gaussians, view, splat::camera_of(view)};
  tbb::parallel_for(std::size_t{0}, blocks,
                    [&](std::size_t b) { reverse_block(source, splats, by_splat, index, b, out, poses[b]); });
  for (const Pose& pose : poses) {
    for (std::size_t k = 0; k < pose.size(); ++k) out.pose[k] += pose[k];
  }
  out.rows = std::move(index.rows);
  return out;
}

}  // namespace edgesplat::train
