// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Times of the CUDA backend, one JSON object a line: what tools/gpu-check runs. Needs a GPU.
#include "common/time/clock.hpp"
#include "common/time/time.hpp"
#include "kernels/splat/cuda_renderer.hpp"
#include "kernels/train/cuda_train_step.hpp"
#include "test/kernels/core/copy_rate.hpp"
#include "test/support/splat_scene.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace edgesplat {
namespace {

struct Options {
  int rounds = 20;
  std::size_t scene = 99;  ///< only this one; 99: all
  bool only_forward = false;
  std::string dump;  ///< folder for the first scene's arrays
};

constexpr test::SplatSceneShape kScenes[] = {
    {1'500'000, 1280, 1024, 0, 3}, {1'500'000, 1280, 1024, 3, 3}, {1'500'000, 1280, 1024, 3, 1},
    {200'000, 1280, 1024, 3, 1},   {50'000, 640, 512, 3, 1},      {10'000, 320, 256, 3, 1},
};

/// Bytes that a frame must move (N Gaussians, Nv visible, T pairs of tile and splat, p passes of the sort):
/// the limit that the times are compared with.
double frame_bytes(const test::SplatSceneShape& shape, const splat::RenderStats& stats) {
  const auto n = static_cast<double>(shape.count), visible = static_cast<double>(stats.visible);
  const auto pairs = static_cast<double>(stats.tile_pairs);
  const double terms = (shape.sh_degree + 1.0) * (shape.sh_degree + 1.0);
  constexpr double kPasses = 4.0;
  return 12.0 * n + (16.0 + 6.0 * terms) * visible + 28.0 * visible + 8.0 * pairs +
         (16.0 * kPasses + 4.0) * pairs + 4.0 * pairs + 28.0 * pairs + 8.0 * shape.width_px * shape.height_px;
}

/// Milliseconds of the middle one of some rounds, after three to warm up.
template <typename Round>
Result<double> median_ms(int rounds, const Round& round) {
  const SteadyClock clock;
  std::vector<double> took_ms;
  for (int i = -3; i < rounds; ++i) {
    const HostTime began = clock.now();
    EDGESPLAT_TRY_STATUS(round());
    if (i >= 0) took_ms.push_back(to_seconds(clock.now() - began) * 1e3);
  }
  std::nth_element(took_ms.begin(), took_ms.begin() + rounds / 2, took_ms.end());
  return took_ms[static_cast<std::size_t>(rounds / 2)];
}

struct Picture {
  explicit Picture(const test::SplatSceneShape& shape)
      : pixels(static_cast<std::size_t>(shape.width_px * shape.height_px)),
        colour(3 * pixels),
        depth_sum_m(pixels),
        alpha(pixels) {}
  [[nodiscard]] splat::BlendOutputs outputs() { return {colour, depth_sum_m, alpha}; }
  std::size_t pixels;
  std::vector<float> colour, depth_sum_m, alpha;
};

Status write(const std::string& file, const std::vector<float>& values) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  if (!out) return fail(Errc::kIo, "cannot write " + file);
  return {};
}

/// What another renderer needs to draw the same.
Status dump(const std::string& folder, const gaussian::GaussianCloud& cloud, const Picture& drawn) {
  EDGESPLAT_TRY_STATUS(write(folder + "/means.f32", cloud.means_m));
  EDGESPLAT_TRY_STATUS(write(folder + "/log_scales.f32", cloud.log_scales));
  EDGESPLAT_TRY_STATUS(write(folder + "/quats_xyzw.f32", cloud.quats_xyzw));
  EDGESPLAT_TRY_STATUS(write(folder + "/opacity_logits.f32", cloud.opacity_logits));
  EDGESPLAT_TRY_STATUS(write(folder + "/sh.f32", cloud.sh));
  return write(folder + "/picture.f32", drawn.colour);
}

Result<double> iteration_ms(const core::Stream& stream, const Options& options,
                            const gaussian::GaussianCloud& cloud, const Picture& target,
                            const splat::View& view, bool in_order, std::size_t& peak_bytes) {
  EDGESPLAT_TRY(const std::size_t budget_bytes, core::share_of_free_vram(0.9));
  core::VramPool pool(budget_bytes);
  train::CudaTrainStep step(pool, {}, in_order);
  EDGESPLAT_TRY_STATUS(step.set_cloud(stream, splat::spans_of(cloud)));
  EDGESPLAT_TRY(const double took_ms, median_ms(options.rounds, [&]() -> Status {
                  const auto report = step.step(stream, view, {target.colour, {}, {}, {}}, {});
                  return report ? Status{} : tl::make_unexpected(report.error());
                }));
  peak_bytes = pool.peak_bytes();
  return took_ms;
}

struct Forward {
  splat::RenderStats stats;
  double took_ms = 0.0;
  std::size_t peak_bytes = 0;
};

/// Draws `cloud` into `picture` once, then again and again on the device.
Result<Forward> forward(const core::Stream& stream, int rounds, const gaussian::GaussianCloud& cloud,
                        const splat::View& view, bool half_precision, Picture& picture) {
  EDGESPLAT_TRY(const std::size_t budget_bytes, core::share_of_free_vram(0.9));
  core::VramPool pool(budget_bytes);
  splat::CudaRenderer renderer(pool, half_precision);
  Forward out;
  EDGESPLAT_TRY_STATUS(renderer.set_cloud(stream, splat::spans_of(cloud)));
  EDGESPLAT_TRY(out.stats, renderer.draw(stream, view, {}, picture.outputs()));
  EDGESPLAT_TRY(out.took_ms, median_ms(rounds, [&]() -> Status {
                  const auto again = renderer.draw_on_device(stream, view, {});
                  return again ? Status{} : tl::make_unexpected(again.error());
                }));
  out.peak_bytes = pool.peak_bytes();
  return out;
}

/// Another cloud like it, as the picture to reach.
Result<Picture> target_of(const core::Stream& stream, test::SplatSceneShape shape, const splat::View& view) {
  shape.seed = 2;
  Picture picture(shape);
  EDGESPLAT_TRY(const Forward drawn,
                forward(stream, 1, test::splat_scene(shape).cloud, view, false, picture));
  (void)drawn;
  return picture;
}

double mebibytes(std::size_t bytes) {
  return static_cast<double>(bytes) / 1048576.0;
}

Status run_scene(const core::Stream& stream, const Options& options, const test::SplatSceneShape& shape,
                 double copy_rate) {
  const test::SplatScene scene = test::splat_scene(shape);
  const gaussian::GaussianCloud& cloud = scene.cloud;
  EDGESPLAT_TRY(const splat::View view, splat::View::from(scene.camera, {}));
  Picture drawn(shape), rounded(shape);
  EDGESPLAT_TRY(const Forward whole, forward(stream, options.rounds, cloud, view, false, drawn));
  EDGESPLAT_TRY(const Forward half, forward(stream, options.rounds, cloud, view, true, rounded));
  const splat::RenderStats& stats = whole.stats;
  if (!options.dump.empty()) EDGESPLAT_TRY_STATUS(dump(options.dump, cloud, drawn));
  const double bytes = frame_bytes(shape, stats);
  const double limit_ms = bytes / copy_rate * 1e3;
  std::printf(
      "{\"resident\": %zu, \"width_px\": %d, \"height_px\": %d, \"sh_degree\": %d, \"visible\": %zu, "
      "\"tile_pairs\": %zu, \"forward_ms\": %.4f, \"forward_half_ms\": %.4f, \"frame_bytes\": %.0f, "
      "\"limit_ms\": %.4f, \"forward_by_limit\": %.2f, \"forward_peak_mib\": %.0f, "
      "\"forward_half_peak_mib\": %.0f",
      shape.count, shape.width_px, shape.height_px, shape.sh_degree, stats.visible, stats.tile_pairs,
      whole.took_ms, half.took_ms, bytes, limit_ms, whole.took_ms / limit_ms, mebibytes(whole.peak_bytes),
      mebibytes(half.peak_bytes));
  if (!options.only_forward) {
    std::size_t peak_bytes = 0;
    EDGESPLAT_TRY(const Picture target, target_of(stream, shape, view));
    EDGESPLAT_TRY(const double ordered_ms,
                  iteration_ms(stream, options, cloud, target, view, true, peak_bytes));
    std::printf(", \"iteration_ordered_ms\": %.4f, \"iteration_ordered_peak_mib\": %.0f", ordered_ms,
                mebibytes(peak_bytes));
    EDGESPLAT_TRY(const double fast_ms,
                  iteration_ms(stream, options, cloud, target, view, false, peak_bytes));
    std::printf(", \"iteration_ms\": %.4f, \"iteration_peak_mib\": %.0f", fast_ms, mebibytes(peak_bytes));
  }
  std::printf("}\n");
  return {};
}

Status run(const Options& options) {
  EDGESPLAT_TRY(const std::string name, core::device_name());
  EDGESPLAT_TRY(const core::Stream stream, core::Stream::create());
  double copy_rate = 0.0;
  {
    core::VramPool pool(std::size_t{1} << 30U);
    EDGESPLAT_TRY(copy_rate, core::copy_rate_bytes_per_s(stream, pool));
  }
  std::printf("{\"device\": \"%s\", \"copy_gb_per_s\": %.1f, \"rounds\": %d}\n", name.c_str(),
              copy_rate * 1e-9, options.rounds);
  for (std::size_t i = 0; i < std::size(kScenes); ++i) {
    if (options.scene == 99 || options.scene == i)
      EDGESPLAT_TRY_STATUS(run_scene(stream, options, kScenes[i], copy_rate));
  }
  return {};
}

}  // namespace
}  // namespace edgesplat

int main(int count, char** words) {
  edgesplat::Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool has_value = i + 1 < count;
    if (word == "--only-forward") {
      options.only_forward = true;
    } else if (word == "--rounds" && has_value) {
      options.rounds = std::max(1, std::atoi(words[++i]));
    } else if (word == "--scene" && has_value) {
      options.scene = static_cast<std::size_t>(std::atoi(words[++i]));
    } else if (word == "--dump" && has_value) {
      options.dump = words[++i];
    } else {
      std::fprintf(stderr, "usage: gpu_bench [--rounds N] [--scene I [--dump DIR]] [--only-forward]\n");
      return 2;
    }
  }
  const auto done = edgesplat::run(options);
  if (done) return 0;
  std::fprintf(stderr, "gpu_bench: %s\n", done.error().context.c_str());
  return 1;
}
