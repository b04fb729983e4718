// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/held_out_scores.hpp"

#include "common/io/image_file.hpp"
#include "robot/render/view.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <system_error>

namespace edgesplat::quality {
namespace {

Result<sensor::ImageRgb8> draw(const gaussian::GaussianCloud& cloud, const HeldOutInput& input,
                               const HeldOutView& view) {
  EDGESPLAT_TRY(render::View drawn,
                render::draw_view(cloud, input.keyframes.front().camera, view.map_from_camera.inverse()));
  return std::move(drawn.picture);
}

Result<HeldOutScore> score_one(const HeldOutInput& input, const HeldOutView& view, std::size_t number,
                               const std::filesystem::path& folder) {
  char stem[16];
  std::snprintf(stem, sizeof stem, "%03zu", number);
  const auto file = [&](const char* what) { return folder / (std::string(stem) + "_" + what + ".png"); };
  HeldOutScore score;
  score.stamp = view.stamp;
  score.stem = stem;
  EDGESPLAT_TRY(const sensor::ImageRgb8 target, input.target(view));
  EDGESPLAT_TRY_STATUS(io::save_image(file("target"), target));
  EDGESPLAT_TRY(const sensor::ImageRgb8 map, draw(input.map, input, view));
  EDGESPLAT_TRY_STATUS(io::save_image(file("map"), map));
  EDGESPLAT_TRY(score.map, score_picture(map, target, input.seen, input.lpips));
  if (input.seeded) {
    EDGESPLAT_TRY(const sensor::ImageRgb8 seeded, draw(*input.seeded, input, view));
    EDGESPLAT_TRY_STATUS(io::save_image(file("seeded"), seeded));
    EDGESPLAT_TRY(score.seeded, score_picture(seeded, target, input.seen, input.lpips));
  }
  EDGESPLAT_TRY(const sensor::ImageRgb8 nearest, io::load_rgb8(input.keyframes[view.nearest_keyframe].image));
  EDGESPLAT_TRY_STATUS(io::save_image(file("nearest"), nearest));
  EDGESPLAT_TRY(score.nearest, score_picture(nearest, target, input.seen, input.lpips));
  return score;
}

}  // namespace

Result<std::vector<HeldOutScore>> score_held_out(const HeldOutInput& input,
                                                 const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(Errc::kIo, "cannot create " + folder.string() + ": " + error.message());
  std::vector<HeldOutScore> scores;
  for (const HeldOutView& view : input.views) {
    EDGESPLAT_TRY(HeldOutScore score, score_one(input, view, scores.size(), folder));
    scores.push_back(std::move(score));
  }
  return scores;
}

nlohmann::json to_json(std::span<const HeldOutScore> scores) {
  nlohmann::json json = {{"psnr_db", nullptr},         {"ssim", nullptr},
                         {"lpips", nullptr},           {"psnr_seeded_db", nullptr},
                         {"psnr_nearest_db", nullptr}, {"views", nlohmann::json::array()}};
  PictureScore map, seeded, nearest;
  double lpips = 0.0;
  bool all_seeded = true;
  bool all_lpips = true;
  for (const HeldOutScore& score : scores) {
    nlohmann::json view = {{"stamp_ns", to_ns(score.stamp)},
                           {"pictures", score.stem},
                           {"psnr_db", score.map.psnr_db},
                           {"ssim", score.map.ssim},
                           {"psnr_nearest_db", score.nearest.psnr_db},
                           {"psnr_seeded_db", nullptr}};
    if (score.seeded) view["psnr_seeded_db"] = score.seeded->psnr_db;
    json["views"].push_back(std::move(view));
    map.psnr_db += score.map.psnr_db;
    map.ssim += score.map.ssim;
    nearest.psnr_db += score.nearest.psnr_db;
    seeded.psnr_db += score.seeded ? score.seeded->psnr_db : 0.0;
    all_seeded = all_seeded && score.seeded.has_value();
    lpips += score.map.lpips.value_or(0.0);
    all_lpips = all_lpips && score.map.lpips.has_value();
  }
  if (scores.empty()) return json;
  const auto count = static_cast<double>(scores.size());
  json["psnr_db"] = map.psnr_db / count;
  json["ssim"] = map.ssim / count;
  json["psnr_nearest_db"] = nearest.psnr_db / count;
  if (all_lpips) json["lpips"] = lpips / count;
  if (all_seeded) json["psnr_seeded_db"] = seeded.psnr_db / count;
  return json;
}

}  // namespace edgesplat::quality
