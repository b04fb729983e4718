// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"
#include "kernels/splat/depth_order.hpp"
#include "kernels/splat/project_backends.hpp"
#include "kernels/splat/splat_lanes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/splat/project_cpu.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_SPLAT_PROJECT_CPU_ONCE
#define EDGESPLAT_KERNELS_SPLAT_PROJECT_CPU_ONCE
namespace edgesplat::splat {

struct ProjectTask {
  const GaussianSpans& gaussians;
  CameraT<float> camera;
  std::array<float, 3> position_m;  ///< of the camera, in map
  float near_m, low_pass_px2, width_px, height_px;
};

/// Some neighbouring rows.
struct ProjectBlock {
  std::size_t first, last;  ///< rows [first, last)
  Splat* splats;            ///< room for all of them
  std::size_t visible = 0;
  std::uint64_t not_finite = 0;
};

}  // namespace edgesplat::splat
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::splat::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kTerms = 16;  // of SH degree 3; lower degrees are padded
constexpr std::size_t kLanes = SplatLanes::kLanes;

HWY_INLINE void load_lanes(const GaussianSpans& g, std::size_t first, std::size_t count, SplatLanes& lanes) {
  const float* mean = &g.means_m[3 * first];
  const float* log_scale = &g.log_scales[3 * first];
  const float* quat = &g.quats_xyzw[4 * first];
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      lanes.mean[k][i] = mean[3 * i + k];
      lanes.log_scale[k][i] = log_scale[3 * i + k];
    }
    for (std::size_t k = 0; k < 4; ++k) lanes.quat[k][i] = quat[4 * i + k];
    lanes.opacity_logit[i] = g.opacity_logits[first + i];
  }
}

/// The shared maths inlined to the last call: only then do its loops become vector operations.
template <bool kFisheye, bool kThin>
[[gnu::flatten]] void project_lanes(const ProjectTask& task, SplatLanes& lanes) {
  CameraT<float> camera = task.camera;  // a copy: else the compiler fears that the lanes overlap it
  camera.fisheye = kFisheye;
  const float near_m = task.near_m, low_pass = task.low_pass_px2, width = task.width_px,
              height = task.height_px;
  if constexpr (kThin) {
    for (int i = 0; i < SplatLanes::kLanes; ++i) lanes.thin_one(camera, i);
  }
  for (int i = 0; i < SplatLanes::kLanes; ++i)
    lanes.project_one<kFisheye, kThin>(camera, near_m, low_pass, width, height, i);
}

HWY_INLINE auto choose_lanes(const ProjectTask& task) {
  const bool thin = task.camera.least_axis_px > 0.0F;
  if (task.camera.fisheye) return thin ? &project_lanes<true, true> : &project_lanes<true, false>;
  return thin ? &project_lanes<false, true> : &project_lanes<false, false>;
}

/// 0.5 + SH towards the camera; `sh` is [terms,3].
HWY_INLINE void add_terms(int degree, const float* sh, const float* basis, float* rgb) {
  const hn::CappedTag<float, kTerms> d;
  const std::size_t floats = 3 * static_cast<std::size_t>((degree + 1) * (degree + 1));
  alignas(64) float padded[3 * kTerms];
  if (floats != 3 * kTerms) {
    std::memset(padded, 0, sizeof(padded));
    std::memcpy(padded, sh, floats * sizeof(float));
    sh = padded;
  }
  auto red = hn::Zero(d), green = red, blue = red;
  for (std::size_t first = 0; first < kTerms; first += hn::Lanes(d)) {
    hn::Vec<decltype(d)> r, g, b;
    hn::LoadInterleaved3(d, sh + 3 * first, r, g, b);
    const auto term = hn::Load(d, basis + first);
    red = hn::MulAdd(term, r, red);
    green = hn::MulAdd(term, g, green);
    blue = hn::MulAdd(term, b, blue);
  }
  rgb[0] = 0.5F + hn::GetLane(hn::SumOfLanes(d, red));
  rgb[1] = 0.5F + hn::GetLane(hn::SumOfLanes(d, green));
  rgb[2] = 0.5F + hn::GetLane(hn::SumOfLanes(d, blue));
}

/// False where the colour is not finite.
HWY_INLINE bool colour_splat(const ProjectTask& task, std::size_t row, Splat& out) {
  const GaussianSpans& g = task.gaussians;
  const float* sh = &g.sh[g.sh_floats_each() * row];
  if (g.sh_degree == 0) {
    constexpr float kConstant = 0.28209479177387814F;
    for (int c = 0; c < 3; ++c) out.rgb[c] = 0.5F + kConstant * sh[c];
  } else {
    float d[3];
    for (std::size_t k = 0; k < 3; ++k) d[k] = g.means_m[3 * row + k] - task.position_m[k];
    const float inverse = 1.0F / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    alignas(64) float basis[kTerms] = {};
    sh_basis(g.sh_degree, d[0] * inverse, d[1] * inverse, d[2] * inverse, basis);
    add_terms(g.sh_degree, sh, basis, out.rgb);
  }
  const float apart = (out.rgb[0] - out.rgb[0]) + (out.rgb[1] - out.rgb[1]) + (out.rgb[2] - out.rgb[2]);
  for (float& channel : out.rgb) channel = channel > 0.0F ? channel : 0.0F;
  return apart == 0.0F;
}

void project_block(const ProjectTask& task, ProjectBlock& block) {
  SplatLanes lanes{};
  for (std::size_t first = block.first; first < block.last; first += kLanes) {
    const std::size_t count = std::min(kLanes, block.last - first);
    load_lanes(task.gaussians, first, count, lanes);
    choose_lanes(task)(task, lanes);
    for (std::size_t i = 0; i < count; ++i) {
      if (lanes.finite[i] == 0.0F) ++block.not_finite;
      if (lanes.visible[i] == 0.0F) continue;
      Splat& out = block.splats[block.visible];
      out.u_px = lanes.u[i];
      out.v_px = lanes.v[i];
      for (int k = 0; k < 3; ++k) out.conic[k] = lanes.conic[k][i];
      out.opacity = lanes.opacity[i];
      out.depth_m = lanes.depth[i];
      out.half_width_px = lanes.half_width[i];
      out.half_height_px = lanes.half_height[i];
      out.reach2 = lanes.reach2[i];
      out.gaussian = static_cast<std::uint32_t>(first + i);
      if (colour_splat(task, first + i, out)) {
        ++block.visible;
      } else {
        ++block.not_finite;
      }
    }
  }
}

}  // namespace edgesplat::splat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::splat {
namespace {

HWY_EXPORT(project_block);

constexpr std::size_t kBlock = 4096;

}  // namespace

void project_cpu(const GaussianSpans& gaussians, const View& view, const RenderOptions& options,
                 ProjectScratch& scratch, Projected& out) {
  const std::size_t count = gaussians.size();
  const ProjectTask task{gaussians,
                         camera_of(view, options),
                         view.position,
                         options.near_m,
                         options.low_pass_px2,
                         static_cast<float>(view.width_px),
                         static_cast<float>(view.height_px)};
  // Each block leaves its visible splats at its own place; what lies between them is never touched.
  if (scratch.splats.size() < count) scratch.splats.resize(count);
  std::vector<ProjectBlock> blocks;
  for (std::size_t first = 0; first < count; first += kBlock)
    blocks.push_back({first, std::min(count, first + kBlock), &scratch.splats[first]});
  thread::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    HWY_DYNAMIC_DISPATCH(project_block)(task, blocks[b]);
  });
  out.not_finite = 0;
  std::vector<std::size_t> starts;
  std::size_t visible = 0;
  for (const ProjectBlock& block : blocks) {
    starts.push_back(visible);
    visible += block.visible;
    out.not_finite += block.not_finite;
  }
  out.culled = count - visible - out.not_finite;
  scratch.keys.resize(visible);
  thread::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    for (std::size_t i = 0; i < blocks[b].visible; ++i) {
      const std::size_t at = blocks[b].first + i;
      scratch.splats[at].order = static_cast<std::uint32_t>(starts[b] + i);
      scratch.keys[starts[b] + i] = {std::bit_cast<std::uint32_t>(scratch.splats[at].depth_m),
                                     static_cast<std::uint32_t>(at)};
    }
  });
  sort_by_depth(scratch.keys, scratch.other_keys);
  out.splats.resize(visible);
  thread::parallel_for(std::size_t{0}, (visible + kBlock - 1) / kBlock, [&](std::size_t b) {
    const std::size_t last = std::min(visible, (b + 1) * kBlock);
    for (std::size_t i = b * kBlock; i < last; ++i) out.splats[i] = scratch.splats[scratch.keys[i].index];
  });
}

}  // namespace edgesplat::splat
#endif
