// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/gaussian_backward.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/splat/splat_one.hpp"
#include "kernels/train/gaussian_lanes.hpp"
#include "kernels/train/sh_backward_math.hpp"

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

EDGESPLAT_SIMD_VARIANTS(reverse_lanes, (const splat::CameraT<float>& camera, GaussianLanes& lanes),
                        (camera, lanes))

void load_lane(const splat::GaussianSpans& g, const splat::Splat& s, const SplatGradient<float>& by,
               std::size_t lane, GaussianLanes& lanes) {
  const std::size_t row = s.gaussian;
  for (std::size_t k = 0; k < 3; ++k) {
    lanes.mean[k][lane] = g.means_m[3 * row + k];
    lanes.log_scale[k][lane] = g.log_scales[3 * row + k];
    lanes.conic[k][lane] = s.conic[k];
    lanes.by_conic[k][lane] = by.conic[k];
  }
  for (std::size_t k = 0; k < 4; ++k) lanes.quat[k][lane] = g.quats_xyzw[4 * row + k];
  lanes.by_u[lane] = by.u;
  lanes.by_v[lane] = by.v;
  lanes.by_depth[lane] = by.depth;
}

/// The colour's share of one Gaussian: fills its SH and adds to its mean and to the pose.
void reverse_colour(const Source& source, const splat::Splat& s, const SplatGradient<float>& by, float* out,
                    float* pose) {
  const splat::GaussianSpans& g = source.gaussians;
  const float* mean = &g.means_m[3 * std::size_t{s.gaussian}];
  const float* position = source.view.position.data();
  const float offset[3] = {mean[0] - position[0], mean[1] - position[1], mean[2] - position[2]};
  float by_offset[3];
  colour_backward(g.sh_degree, offset, &g.sh[g.sh_floats_each() * s.gaussian], s.rgb, by.rgb,
                  out + ParameterRow::kSh, by_offset);
  if (g.sh_degree == 0) return;  // the same from everywhere
  const float by_position[3] = {-by_offset[0], -by_offset[1], -by_offset[2]};
  // The camera's position -R^T t goes with the pose as well: dr turns it by position x dr, dt moves it by
  // -R^T dt.
  float turn[3];
  cross(by_position, position, turn);
  const float* r = source.camera.rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    out[ParameterRow::kMean + k] += by_offset[k];
    pose[k] += turn[k];
    pose[3 + k] += r[3 * k] * by_offset[0] + r[3 * k + 1] * by_offset[1] + r[3 * k + 2] * by_offset[2];
  }
}

/// Fills `out` (a ParameterRow) from one lane and adds to the pose's gradient; zeros where a value is not
/// finite.
void store_lane(const Source& source, const splat::Splat& s, const SplatGradient<float>& by,
                const GaussianLanes& lanes, std::size_t lane, float* out, Pose& pose) {
  for (std::size_t k = 0; k < 3; ++k) {
    out[ParameterRow::kMean + k] = lanes.by_mean[k][lane];
    out[ParameterRow::kLogScale + k] = lanes.by_log_scale[k][lane];
  }
  for (std::size_t k = 0; k < 4; ++k) out[ParameterRow::kQuat + k] = lanes.by_quat[k][lane];
  out[ParameterRow::kOpacity] = by.opacity * s.opacity * (1.0F - s.opacity);
  float by_pose[6];
  for (std::size_t k = 0; k < 6; ++k) by_pose[k] = lanes.pose[k][lane];
  reverse_colour(source, s, by, out, by_pose);
  const std::size_t used = ParameterRow::size(source.gaussians.sh_degree);
  std::fill(out + used, out + ParameterRow::stride(source.gaussians.sh_degree), 0.0F);
  if (!splat::all_finite(out, static_cast<int>(used)) || !splat::all_finite(by_pose, 6)) {
    std::fill_n(out, used, 0.0F);
    return;
  }
  for (std::size_t k = 0; k < 6; ++k) pose[k] += static_cast<double>(by_pose[k]);
}

struct Splats {
  std::span<const splat::Splat> splats;
  std::span<const SplatBackward> by_splat;
};

/// Which splat shows each row of the cloud, and the rows that one does.
struct Index {
  std::vector<std::uint32_t> rows;    ///< ascending
  std::vector<std::uint32_t> splats;  ///< [rows]
};

/// Only splats that some pixel shows: those hidden behind others have no gradient, and stay as they are.
Index by_row(const Splats& in, std::size_t gaussians) {
  std::vector<std::uint32_t> splat_of(gaussians, kUnseen);
  for (std::size_t i = 0; i < in.splats.size(); ++i) {
    if (in.by_splat[i].weight > 0.0F) splat_of[in.splats[i].gaussian] = static_cast<std::uint32_t>(i);
  }
  Index index;
  index.rows.reserve(in.splats.size());
  index.splats.reserve(in.splats.size());
  for (std::size_t row = 0; row < gaussians; ++row) {
    if (splat_of[row] == kUnseen) continue;
    index.rows.push_back(static_cast<std::uint32_t>(row));
    index.splats.push_back(splat_of[row]);
  }
  return index;
}

void reverse_block(const Source& source, const Splats& in, const Index& index, std::size_t block,
                   GaussianGradients& out, Pose& pose) {
  constexpr std::size_t kLanes = GaussianLanes::kLanes;
  const auto reverse_lanes = fastest_reverse_lanes();
  const std::size_t last = std::min(index.rows.size(), (block + 1) * kBlock);
  GaussianLanes lanes{};
  for (std::size_t first = block * kBlock; first < last; first += kLanes) {
    const std::size_t count = std::min(kLanes, last - first);
    for (std::size_t i = 0; i < count; ++i) {
      // Splats lie in the order of depth, so all over memory.
      const std::size_t ahead = index.splats[std::min(first + i + kLanes, last - 1)];
      __builtin_prefetch(&in.splats[ahead]);
      __builtin_prefetch(&in.by_splat[ahead]);
      const std::size_t k = index.splats[first + i];
      load_lane(source.gaussians, in.splats[k], in.by_splat[k].gradient, i, lanes);
    }
    reverse_lanes(source.camera, lanes);
    for (std::size_t i = 0; i < count; ++i) {
      const splat::Splat& s = in.splats[index.splats[first + i]];
      const SplatBackward& by = in.by_splat[index.splats[first + i]];
      store_lane(source, s, by.gradient, lanes, i, &out.values[(first + i) * out.stride], pose);
      const float centre = std::sqrt(by.gradient.u * by.gradient.u + by.gradient.v * by.gradient.v);
      out.sightings[first + i] = {centre, by.weight, std::max(s.half_width_px, s.half_height_px)};
    }
  }
}

}  // namespace

void gaussian_backward(const splat::GaussianSpans& gaussians, const splat::View& view,
                       std::span<const splat::Splat> splats, std::span<const SplatBackward> by_splat,
                       GaussianGradients& out) {
  EDGESPLAT_CHECK(gaussians.consistent() && splats.size() == by_splat.size(), "a gradient for every splat");
  out.stride = ParameterRow::stride(gaussians.sh_degree);
  Index index = by_row({splats, by_splat}, gaussians.size());
  out.values.resize(index.rows.size() * out.stride);
  out.sightings.resize(index.rows.size());
  const std::size_t blocks = (index.rows.size() + kBlock - 1) / kBlock;
  std::vector<Pose> poses(blocks, Pose{});
  const Source source{gaussians, view, splat::camera_of(view)};
  thread::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    reverse_block(source, {splats, by_splat}, index, b, out, poses[b]);
  });
  out.pose = {};
  for (const Pose& pose : poses) {
    for (std::size_t k = 0; k < pose.size(); ++k) out.pose[k] += pose[k];
  }
  out.rows = std::move(index.rows);
}

}  // namespace edgesplat::train
