// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/parallel_for.hpp"
#include "kernels/splat/depth_order.hpp"
#include "kernels/splat/project_backends.hpp"
#include "kernels/splat/splat_one.hpp"

#include <algorithm>

namespace edgesplat::splat {
namespace {

constexpr std::size_t kBlock = 4096;

struct Block {
  std::vector<Splat> splats;
  std::uint64_t not_finite = 0;
  std::uint64_t culled = 0;
};

void project_block(const GaussianSpans& g, const View& view, const RenderOptions& options, std::size_t first,
                   std::size_t last, Block& block) {
  const CameraT<float> camera = camera_of(view);
  const std::size_t sh_floats = g.sh_floats_each();
  Splat splat{};
  block.splats.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const SplatInput in{&g.means_m[3 * i],   &g.log_scales[3 * i], &g.quats_xyzw[4 * i],
                        g.opacity_logits[i], &g.sh[sh_floats * i], g.sh_degree};
    splat.gaussian = static_cast<std::uint32_t>(i);
    switch (splat_one(in, camera, view.position.data(), options.near_m, options.low_pass_px2,
                      static_cast<float>(view.width_px), static_cast<float>(view.height_px), splat)) {
      case SplatOutcome::kVisible:
        block.splats.push_back(splat);
        break;
      case SplatOutcome::kCulled:
        ++block.culled;
        break;
      case SplatOutcome::kNotFinite:
        ++block.not_finite;
        break;
    }
  }
}

}  // namespace

Projected project_cpu(const GaussianSpans& gaussians, const View& view, const RenderOptions& options) {
  const std::size_t count = gaussians.size();
  std::vector<Block> blocks((count + kBlock - 1) / kBlock);
  thread::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    project_block(gaussians, view, options, b * kBlock, std::min(count, (b + 1) * kBlock), blocks[b]);
  });
  Projected out;
  std::size_t visible_count = 0;
  for (const Block& block : blocks) visible_count += block.splats.size();
  std::vector<Splat> visible;
  visible.reserve(visible_count);
  for (const Block& block : blocks) {
    visible.insert(visible.end(), block.splats.begin(), block.splats.end());
    out.not_finite += block.not_finite;
    out.culled += block.culled;
  }
  out.splats = sorted_by_depth(visible);
  return out;
}

}  // namespace edgesplat::splat
