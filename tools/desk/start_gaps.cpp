// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/start_gaps.hpp"

#include "kernels/mapping/plane_sweep.hpp"
#include "kernels/splat/render.hpp"
#include "tools/desk/picture_stages.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace edgesplat::desk {
namespace {

using mapping::PixelDepth;
using mapping::StoredView;

/// Start points count as solid while gaps are looked for, whatever opacity training starts with.
constexpr float kSolidLogit = 3.0F;
constexpr std::size_t kPartners = 4;  ///< that a picture is compared with at most are among so many
constexpr float kNearShare = 0.02F,
                kFarShare = 0.98F;  ///< of the depths of points that count as near and far

/// What the map so far shows of a view.
struct Drawn {
  std::vector<float> colour, depth_sum_m, alpha;
};

/// Depths of a view on a grid of every `stride` pixels, 0 where unknown.
class DepthGrid {
 public:
  DepthGrid(const geometry::CameraModel& camera, int stride)
      : stride_(stride),
        columns_((camera.width_px + stride - 1) / stride),
        rows_((camera.height_px + stride - 1) / stride),
        depth_m_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0F) {}

  [[nodiscard]] float& at(int column, int row) {
    return depth_m_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int stride() const { return stride_; }

  /// Unknown depths become those of the nearest known, in rings around these. Nothing known: nothing done.
  void spread() {
    std::vector<std::pair<int, int>> ring, next;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (at(column, row) > 0.0F) ring.emplace_back(column, row);
      }
    }
    for (; !ring.empty(); std::swap(ring, next)) {
      next.clear();
      for (const auto& [column, row] : ring) {
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int x = column + dx, y = row + dy;
          if (x < 0 || y < 0 || x >= columns_ || y >= rows_ || at(x, y) > 0.0F) continue;
          at(x, y) = at(column, row);
          next.emplace_back(x, y);
        }
      }
    }
  }

 private:
  int stride_, columns_, rows_;
  std::vector<float> depth_m_;
};

class GapFiller {
 public:
  GapFiller(std::span<const ScenePicture* const> pictures, const gaussian::GaussianCloud& start,
            const GapOptions& options, mapping::IdAllocator& ids)
      : options_(options), ids_(ids), solid_(start) {
    std::ranges::fill(solid_.opacity_logits, kSolidLogit);
    added_.sh_degree = start.sh_degree;
    for (const ScenePicture* picture : pictures) views_.push_back(view_of(half_size(*picture)));
  }

  Result<gaussian::GaussianCloud> fill() {
    for (const StoredView& view : views_) {
      EDGESPLAT_TRY(const Drawn drawn, draw(view));
      fill(view, drawn);
      if (added_.size() >= options_.most) break;
    }
    return std::move(added_);
  }

 private:
  [[nodiscard]] StoredView view_of(ScenePicture small) const {
    StoredView view;
    view.map_from_camera = small.map_from_camera;
    view.map_from_camera.translation_m *= options_.scale;
    view.undistorter = std::make_shared<image::Undistorter>(small.camera);
    view.picture = std::move(small.picture);
    view.ignored.assign(small.weight.size(), false);
    for (std::size_t i = 0; i < small.weight.size(); ++i) view.ignored[i] = small.weight[i] <= 0.0F;
    return view;
  }

  Result<Drawn> draw(const StoredView& view) {
    const std::size_t pixels = view.picture.values.size() / 3;
    Drawn drawn{std::vector<float>(3 * pixels), std::vector<float>(pixels), std::vector<float>(pixels)};
    EDGESPLAT_TRY(const splat::View from, splat::View::from(view.camera(), view.map_from_camera.inverse()));
    EDGESPLAT_TRY_STATUS(splat::render_cpu(splat::spans_of(solid_), from, {},
                                           {drawn.colour, drawn.depth_sum_m, drawn.alpha}, scratch_));
    return drawn;
  }

  /// Between which depths to look: those of what the view shows, and far beyond.
  [[nodiscard]] mapping::SweepOptions sweep_options(const Drawn& drawn, int stride_px) const {
    std::vector<float> depths;
    for (std::size_t i = 0; i < drawn.alpha.size(); i += 3) {
      if (drawn.alpha[i] >= options_.max_alpha) depths.push_back(drawn.depth_sum_m[i] / drawn.alpha[i]);
    }
    mapping::SweepOptions out;
    out.stride_px = stride_px;
    out.max_alpha = options_.max_alpha;
    if (depths.empty()) return out;
    std::ranges::sort(depths);
    const auto at = [&depths](float share) {
      return depths[static_cast<std::size_t>(share * static_cast<float>(depths.size() - 1))];
    };
    out.nearest_m = 0.5F * at(kNearShare);
    out.farthest_m = 4.0F * at(kFarShare);
    out.baseline_m = 0.05F * at(0.5F);
    return out;
  }

  /// Those that look the same way first.
  [[nodiscard]] std::vector<const StoredView*> others_by_direction(const StoredView& view) const {
    std::vector<std::pair<double, const StoredView*>> others;
    for (const StoredView& other : views_) {
      if (&other == &view) continue;
      others.emplace_back(other.map_from_camera.rotation.angularDistance(view.map_from_camera.rotation),
                          &other);
    }
    std::ranges::stable_sort(others, {}, &std::pair<double, const StoredView*>::first);
    std::vector<const StoredView*> out;
    for (const auto& other : others) out.push_back(other.second);
    return out;
  }

  void fill(const StoredView& view, const Drawn& drawn) {
    const int stride_px = std::clamp(view.camera().width_px / options_.columns, 1, 32);
    const mapping::SweepOptions options = sweep_options(drawn, stride_px);
    const auto partners = mapping::sweep_partners(view, others_by_direction(view), options);
    DepthGrid grid(view.camera(), options.stride_px);
    for (const PixelDepth& swept : mapping::sweep_depths(view, partners, nullptr, drawn.alpha, options))
      grid.at(swept.x / options.stride_px, swept.y / options.stride_px) = swept.depth_m;
    const auto width = static_cast<std::size_t>(view.camera().width_px);
    const auto pixel_of = [&](int column, int row) {
      return static_cast<std::size_t>(row * grid.stride()) * width +
             static_cast<std::size_t>(column * grid.stride());
    };
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        const std::size_t pixel = pixel_of(column, row);
        if (drawn.alpha[pixel] >= options.max_alpha)
          grid.at(column, row) = drawn.depth_sum_m[pixel] / drawn.alpha[pixel];
      }
    }
    grid.spread();
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        const std::size_t pixel = pixel_of(column, row);
        const bool counts = view.ignored.empty() || !view.ignored[pixel];
        const float depth_m = grid.at(column, row);
        if (drawn.alpha[pixel] < options.max_alpha && counts && depth_m > 0.0F &&
            added_.size() < options_.most)
          add(view, {column * grid.stride(), row * grid.stride(), depth_m}, grid.stride());
      }
    }
  }

  void add(const StoredView& view, const PixelDepth& at, int stride_px) {
    const geometry::CameraModel& camera = view.camera();
    const Eigen::Vector3d in_camera =
        mapping::ray_of(camera, at.x, at.y).cast<double>() * static_cast<double>(at.depth_m);
    const Eigen::Vector3f mean = (view.map_from_camera * in_camera).cast<float>();
    const float sigma = static_cast<float>(stride_px) * at.depth_m / static_cast<float>(camera.fx_px);
    const std::uint8_t* rgb = view.picture.pixel(at.x, at.y);
    gaussian::GaussianCloud one;
    one.sh_degree = added_.sh_degree;
    one.resize(1);
    one.ids[0] = ids_.next();
    for (std::size_t i = 0; i < 3; ++i) {
      one.means_m[i] = mean[static_cast<Eigen::Index>(i)];
      one.log_scales[i] = std::log(sigma);
      one.sh[i] = (static_cast<float>(rgb[i]) / 255.0F - 0.5F) / gaussian::GaussianCloud::kShC0;
    }
    one.quats_xyzw[3] = 1.0F;
    one.opacity_logits[0] = std::log(options_.opacity / (1.0F - options_.opacity));
    added_.append_row(one, 0);
    one.opacity_logits[0] = kSolidLogit;
    solid_.append_row(one, 0);
  }

  const GapOptions& options_;
  mapping::IdAllocator& ids_;
  gaussian::GaussianCloud solid_;  ///< the start and what was added, solid
  gaussian::GaussianCloud added_;
  std::vector<StoredView> views_;  ///< of half the size, in the training's units
  splat::RenderScratch scratch_;
};

}  // namespace

Result<gaussian::GaussianCloud> gaussians_in_gaps(std::span<const ScenePicture* const> pictures,
                                                  const gaussian::GaussianCloud& start,
                                                  const GapOptions& options, mapping::IdAllocator& ids) {
  return GapFiller(pictures, start, options, ids).fill();
}

}  // namespace edgesplat::desk
