// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/gaussian_backward.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"
#include "kernels/splat/splat_one.hpp"
#include "kernels/train/gaussian_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/train/gaussian_backward.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/train/sh_backward_math.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_TRAIN_GAUSSIAN_BACKWARD_ONCE
#define EDGESPLAT_KERNELS_TRAIN_GAUSSIAN_BACKWARD_ONCE
namespace edgesplat::train {

struct ReverseSource {
  const splat::GaussianSpans& gaussians;
  splat::CameraT<float> camera;
  float low_pass_px2;
  std::array<float, 3> position_m;  ///< of the camera, in map
};

/// One block's gradients: in the cache, thread by thread.
struct BlockMemory {
  alignas(64) float values[kGradientBlock * ParameterRow::kMaxStride];
  std::uint32_t rows[kGradientBlock];
  Sighting sightings[kGradientBlock];
  std::size_t count;
};

}  // namespace edgesplat::train
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kTerms = 16;  // of SH degree 3; lower degrees are padded

HWY_INLINE void load_lane(const splat::GaussianSpans& g, const SplatBackward& by, std::size_t lane,
                          GaussianLanes& lanes) {
  const std::size_t row = by.gaussian;
  for (std::size_t k = 0; k < 3; ++k) {
    lanes.mean[k][lane] = g.means_m[3 * row + k];
    lanes.log_scale[k][lane] = g.log_scales[3 * row + k];
    lanes.conic[k][lane] = by.conic[k];
    lanes.by_conic[k][lane] = by.by_conic[k];
  }
  for (std::size_t k = 0; k < 4; ++k) lanes.quat[k][lane] = g.quats_xyzw[4 * row + k];
  lanes.by_u[lane] = by.by_u;
  lanes.by_v[lane] = by.by_v;
  lanes.by_depth[lane] = by.by_depth;
  lanes.by_log_opacity[lane] = by.by_log_opacity;
  lanes.opacity_logit[lane] = g.opacity_logits[row];
}

/// dL by the SH coefficients of one Gaussian, from those by its colour, and by each term of the basis: what
/// the colour takes from the direction. `sh` and `by_sh` are [terms,3].
HWY_INLINE void reverse_basis(int degree, const float* sh, const float* basis, const float* by_rgb,
                              float* by_sh, float* by_basis) {
  const hn::CappedTag<float, kTerms> d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t floats = 3 * static_cast<std::size_t>((degree + 1) * (degree + 1));
  alignas(64) float padded[3 * kTerms];
  const bool whole = floats == 3 * kTerms;
  if (!whole) {
    std::memset(padded, 0, sizeof(padded));
    std::memcpy(padded, sh, floats * sizeof(float));
    sh = padded;
  }
  alignas(64) float out[3 * kTerms];
  const auto r = hn::Set(d, by_rgb[0]), g = hn::Set(d, by_rgb[1]), b = hn::Set(d, by_rgb[2]);
  for (std::size_t first = 0; first < kTerms; first += lanes) {
    hn::Vec<decltype(d)> red, green, blue;
    hn::LoadInterleaved3(d, sh + 3 * first, red, green, blue);
    hn::Store(hn::MulAdd(red, r, hn::MulAdd(green, g, hn::Mul(blue, b))), d, by_basis + first);
    const auto term = hn::Load(d, basis + first);
    hn::StoreInterleaved3(hn::Mul(term, r), hn::Mul(term, g), hn::Mul(term, b), d,
                          (whole ? by_sh : out) + 3 * first);
  }
  if (!whole) std::memcpy(by_sh, out, floats * sizeof(float));
}

/// The colour's share of one Gaussian: fills its SH and adds to its mean and to the pose.
HWY_INLINE void reverse_colour(const ReverseSource& source, const SplatBackward& by, float* out,
                               float* pose) {
  const splat::GaussianSpans& g = source.gaussians;
  if (g.sh_degree == 0) {  // the same from everywhere
    constexpr float kConstant = 0.28209479177387814F;
    for (int c = 0; c < 3; ++c)
      out[ParameterRow::kSh + static_cast<std::size_t>(c)] = kConstant * by.by_rgb[c];
    return;
  }
  const float* mean = &g.means_m[3 * std::size_t{by.gaussian}];
  const float* position = source.position_m.data();
  const float offset[3] = {mean[0] - position[0], mean[1] - position[1], mean[2] - position[2]};
  const float length = std::sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const float towards[3] = {offset[0] / length, offset[1] / length, offset[2] / length};
  alignas(64) float basis[kTerms] = {};
  alignas(64) float by_basis[kTerms];
  splat::sh_basis(g.sh_degree, towards[0], towards[1], towards[2], basis);
  reverse_basis(g.sh_degree, &g.sh[g.sh_floats_each() * by.gaussian], basis, by.by_rgb,
                out + ParameterRow::kSh, by_basis);
  float by_towards[3];
  sh_direction_backward(g.sh_degree, towards[0], towards[1], towards[2], by_basis, by_towards);
  const float radial = by_towards[0] * towards[0] + by_towards[1] * towards[1] + by_towards[2] * towards[2];
  float by_offset[3];
  for (int k = 0; k < 3; ++k) by_offset[k] = (by_towards[k] - towards[k] * radial) / length;
  // The camera's position -R^T t goes with the pose as well: dr turns it by position x dr, dt moves it by
  // -R^T dt.
  const float by_position[3] = {-by_offset[0], -by_offset[1], -by_offset[2]};
  float turn[3];
  cross(by_position, position, turn);
  const float* r = source.camera.rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    out[ParameterRow::kMean + k] += by_offset[k];
    pose[k] += turn[k];
    pose[3 + k] += r[3 * k] * by_offset[0] + r[3 * k + 1] * by_offset[1] + r[3 * k + 2] * by_offset[2];
  }
}

/// x - x is 0 for every finite x and for nothing else.
HWY_INLINE bool all_finite(const float* values, std::size_t whole_vectors_of_16) {
  const hn::CappedTag<float, 16> d;
  auto apart = hn::Zero(d);
  for (std::size_t i = 0; i < whole_vectors_of_16; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, values + i);
    apart = hn::Add(apart, hn::Sub(x, x));
  }
  return hn::AllTrue(d, hn::Eq(apart, hn::Zero(d)));
}

/// Fills `out` (a ParameterRow) from one lane and adds to the pose's gradient; zeros where a value is not
/// finite.
HWY_INLINE void store_lane(const ReverseSource& source, const SplatBackward& by, const GaussianLanes& lanes,
                           std::size_t lane, float* out, PoseGradient& pose) {
  const std::size_t stride = ParameterRow::stride(source.gaussians.sh_degree);
  for (std::size_t k = 0; k < 3; ++k) {
    out[ParameterRow::kMean + k] = lanes.by_mean[k][lane];
    out[ParameterRow::kLogScale + k] = lanes.by_log_scale[k][lane];
  }
  for (std::size_t k = 0; k < 4; ++k) out[ParameterRow::kQuat + k] = lanes.by_quat[k][lane];
  out[ParameterRow::kOpacity] = lanes.by_opacity_logit[lane];
  float by_pose[6];
  for (std::size_t k = 0; k < 6; ++k) by_pose[k] = lanes.pose[k][lane];
  reverse_colour(source, by, out, by_pose);
  const std::size_t used = ParameterRow::size(source.gaussians.sh_degree);
  std::fill(out + used, out + stride, 0.0F);
  float pose_apart = 0.0F;
  for (const float value : by_pose) pose_apart += value - value;
  if (!all_finite(out, stride) || !(pose_apart == 0.0F)) {
    std::fill_n(out, stride, 0.0F);
    return;
  }
  for (std::size_t k = 0; k < 6; ++k) pose[k] += static_cast<double>(by_pose[k]);
}

/// The shared maths inlined to the last call: only then do its loops become vector operations.
template <bool kFisheye>
[[gnu::flatten]] void reverse_lanes(const ReverseSource& source, GaussianLanes& lanes) {
  reverse_lanes_inline<kFisheye>(source.camera, source.low_pass_px2, lanes);
}

/// `splats` is the block's share of all of them.
void reverse_rows(const ReverseSource& source, std::span<const SplatBackward> splats, BlockMemory& out,
                  PoseGradient& pose) {
  constexpr std::size_t kLanes = GaussianLanes::kLanes;
  const std::size_t stride = ParameterRow::stride(source.gaussians.sh_degree);
  const SplatBackward* seen[kGradientBlock];
  out.count = 0;
  for (const SplatBackward& by : splats) {
    if (by.weight > 0.0F) seen[out.count++] = &by;
  }
  GaussianLanes lanes{};
  for (std::size_t first = 0; first < out.count; first += kLanes) {
    const std::size_t count = std::min(kLanes, out.count - first);
    for (std::size_t i = 0; i < count; ++i) load_lane(source.gaussians, *seen[first + i], i, lanes);
    if (source.camera.fisheye) {
      reverse_lanes<true>(source, lanes);
    } else {
      reverse_lanes<false>(source, lanes);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const SplatBackward& by = *seen[first + i];
      store_lane(source, by, lanes, i, &out.values[(first + i) * stride], pose);
      out.rows[first + i] = by.gaussian;
      out.sightings[first + i] = {std::sqrt(by.by_u * by.by_u + by.by_v * by.by_v), by.weight, by.radius_px};
    }
  }
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::train {
namespace {

HWY_EXPORT(reverse_rows);

}  // namespace

PoseGradient gaussian_backward_in_blocks(const splat::GaussianSpans& gaussians, const splat::View& view,
                                         const splat::RenderOptions& options,
                                         std::span<const SplatBackward> by_row, const BlockTaker& take) {
  EDGESPLAT_CHECK(gaussians.consistent(), "Gaussian arrays of one length");
  const std::size_t stride = ParameterRow::stride(gaussians.sh_degree);
  std::vector<PoseGradient> poses(gradient_blocks(by_row.size()), PoseGradient{});
  const ReverseSource source{gaussians, splat::camera_of(view, options), options.low_pass_px2, view.position};
  thread::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t b) {
    thread_local BlockMemory memory;
    const std::size_t first = b * kGradientBlock;
    HWY_DYNAMIC_DISPATCH(reverse_rows)
    (source, by_row.subspan(first, std::min(kGradientBlock, by_row.size() - first)), memory, poses[b]);
    const std::size_t count = memory.count;
    take({b, {memory.rows, count}, {memory.values, count * stride}, {memory.sightings, count}});
  });
  PoseGradient pose{};
  for (const PoseGradient& part : poses) {
    for (std::size_t k = 0; k < pose.size(); ++k) pose[k] += part[k];
  }
  return pose;
}

GaussianGradients gaussian_backward(const splat::GaussianSpans& gaussians, const splat::View& view,
                                    const splat::RenderOptions& options,
                                    std::span<const SplatBackward> by_row) {
  std::vector<GaussianGradients> parts(gradient_blocks(by_row.size()));
  GaussianGradients out;
  out.pose =
      gaussian_backward_in_blocks(gaussians, view, options, by_row, [&parts](const GradientBlock& block) {
        GaussianGradients& part = parts[block.number];
        part.rows.assign(block.rows.begin(), block.rows.end());
        part.values.assign(block.values.begin(), block.values.end());
        part.sightings.assign(block.sightings.begin(), block.sightings.end());
      });
  out.stride = ParameterRow::stride(gaussians.sh_degree);
  for (const GaussianGradients& part : parts) {
    out.rows.insert(out.rows.end(), part.rows.begin(), part.rows.end());
    out.values.insert(out.values.end(), part.values.begin(), part.values.end());
    out.sightings.insert(out.sightings.end(), part.sightings.begin(), part.sightings.end());
  }
  return out;
}

}  // namespace edgesplat::train
#endif
