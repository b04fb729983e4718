// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/held_out.hpp"

#include "common/io/image_file.hpp"
#include "tools/desk/render_set.hpp"
#include "tools/quality/picture_score.hpp"

namespace edgesplat::desk {

Result<HeldOutMeans> score_pictures(const gaussian::GaussianCloud& map,
                                    std::span<const ScenePicture* const> pictures, quality::Lpips* lpips,
                                    const std::filesystem::path& renders, const Clock& clock) {
  if (pictures.empty()) return fail(Errc::kInvalidArgument, "no held-out picture to compare with");
  if (!renders.empty()) {
    std::error_code error;
    std::filesystem::create_directories(renders, error);
    if (error) return fail(Errc::kIo, "cannot make the folder " + renders.string() + ": " + error.message());
  }
  HeldOutMeans means;
  if (lpips != nullptr) means.lpips = 0.0;
  const double share = 1.0 / static_cast<double>(pictures.size());
  for (const ScenePicture* picture : pictures) {
    const io::PosedCamera camera{picture->name, {}, picture->camera, picture->map_from_camera, {}};
    EDGESPLAT_TRY(const RenderedView view, render_view(map, camera, {}, clock));
    EDGESPLAT_TRY(const auto score,
                  quality::score_picture(view.picture, picture->picture, picture->weight, lpips));
    means.psnr_db += share * score.psnr_db;
    means.ssim += share * score.ssim;
    if (means.lpips) *means.lpips += share * score.lpips.value_or(0.0);
    means.render_ms += share * view.render_ms;
    if (renders.empty()) continue;
    EDGESPLAT_TRY_STATUS(io::save_image(renders / (picture->name + ".png"), view.picture));
    EDGESPLAT_TRY_STATUS(io::save_image(renders / (picture->name + "_real.png"), picture->picture));
  }
  return means;
}

}  // namespace edgesplat::desk
