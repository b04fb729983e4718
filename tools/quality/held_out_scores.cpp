// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/held_out_scores.hpp"

#include "common/io/image_file.hpp"
#include "robot/render/view.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <span>
#include <system_error>

namespace edgesplat::quality {
namespace {

Result<sensor::ImageRgb8> draw(const gaussian::GaussianCloud& cloud, const HeldOutInput& input,
                               const HeldOutView& view) {
  EDGESPLAT_TRY(render::View drawn,
                render::draw_view(cloud, input.keyframes.front().camera, view.map_from_camera.inverse()));
  return std::move(drawn.picture);
}

/// Of the size of the picture that it weighs; white counts.
sensor::ImageGray8 picture_of_weight(const HeldOutTruth& truth) {
  sensor::ImageGray8 picture(truth.picture.width_px, truth.picture.height_px, 255);
  for (std::size_t i = 0; i < truth.weight.size() && i < picture.values.size(); ++i) {
    picture.values[i] = static_cast<std::uint8_t>(std::lround(255.0F * truth.weight[i]));
  }
  return picture;
}

Result<HeldOutScore> score_one(const HeldOutInput& input, const HeldOutView& view, std::size_t number,
                               const std::filesystem::path& folder) {
  char stem[16];
  std::snprintf(stem, sizeof stem, "%03zu", number);
  const auto file = [&](const char* what) { return folder / (std::string(stem) + "_" + what + ".png"); };
  HeldOutScore score;
  score.stamp = view.stamp;
  score.block = view.block;
  score.stem = stem;
  EDGESPLAT_TRY(const HeldOutTruth truth, input.truth(view));
  const auto against_truth = [&](const sensor::ImageRgb8& picture) {
    return score_picture(picture, truth.picture, truth.weight, input.lpips);
  };
  score.static_share = share_that_counts(truth.weight);
  EDGESPLAT_TRY_STATUS(io::save_image(file("target"), truth.picture));
  if (input.kind == HeldOutKind::kReal) {
    EDGESPLAT_TRY_STATUS(io::save_image(file("weight"), picture_of_weight(truth)));
  }
  EDGESPLAT_TRY(const sensor::ImageRgb8 map, draw(input.map, input, view));
  EDGESPLAT_TRY_STATUS(io::save_image(file("map"), map));
  EDGESPLAT_TRY(score.map, against_truth(map));
  if (input.seeded) {
    EDGESPLAT_TRY(const sensor::ImageRgb8 seeded, draw(*input.seeded, input, view));
    EDGESPLAT_TRY_STATUS(io::save_image(file("seeded"), seeded));
    EDGESPLAT_TRY(score.seeded, against_truth(seeded));
  }
  EDGESPLAT_TRY(const sensor::ImageRgb8 nearest, io::load_rgb8(input.keyframes[view.nearest_keyframe].image));
  EDGESPLAT_TRY_STATUS(io::save_image(file("nearest"), nearest));
  EDGESPLAT_TRY(score.nearest, against_truth(nearest));
  if (!truth.weight_with_shadows.empty()) {
    const auto psnr_db = [&](const sensor::ImageRgb8& picture) -> Result<double> {
      EDGESPLAT_TRY(const PictureScore shadowed,
                    score_picture(picture, truth.picture, truth.weight_with_shadows, nullptr));
      return shadowed.psnr_db;
    };
    EDGESPLAT_TRY(score.psnr_with_shadows_db, psnr_db(map));
    EDGESPLAT_TRY(score.psnr_nearest_with_shadows_db, psnr_db(nearest));
  }
  return score;
}

nlohmann::json to_json(const HeldOutScore& score) {
  nlohmann::json view = {
      {"stamp_ns", to_ns(score.stamp)}, {"pictures", score.stem}, {"static_share", score.static_share},
      {"psnr_db", score.map.psnr_db},   {"ssim", score.map.ssim}, {"psnr_nearest_db", score.nearest.psnr_db},
      {"psnr_seeded_db", nullptr}};
  if (score.block) view["block"] = *score.block;
  if (score.seeded) view["psnr_seeded_db"] = score.seeded->psnr_db;
  return view;
}

/// Of what every view has; null where one lacks it, or where there is none.
template <typename Value>
nlohmann::json mean(std::span<const HeldOutScore> scores, Value value) {
  double sum = 0.0;
  for (const HeldOutScore& score : scores) {
    const std::optional<double> one = value(score);
    if (!one) return nullptr;
    sum += *one;
  }
  if (scores.empty()) return nullptr;
  return sum / static_cast<double>(scores.size());
}

}  // namespace

Result<HeldOutScores> score_held_out(const HeldOutInput& input, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(Errc::kIo, "cannot create " + folder.string() + ": " + error.message());
  HeldOutScores scores{input.kind, input.movers_masked, {}};
  for (const HeldOutView& view : input.views) {
    EDGESPLAT_TRY(HeldOutScore score, score_one(input, view, scores.views.size(), folder));
    scores.views.push_back(std::move(score));
  }
  return scores;
}

nlohmann::json to_json(const HeldOutScores& scores) {
  using Mean = std::optional<double>;
  const std::span<const HeldOutScore> all = scores.views;
  nlohmann::json json = {
      {"kind", scores.kind == HeldOutKind::kReal ? "real" : "simulated"},
      {"movers_masked", scores.movers_masked},
      {"static_share", mean(all, [](const auto& score) { return Mean(score.static_share); })},
      {"psnr_db", mean(all, [](const auto& score) { return Mean(score.map.psnr_db); })},
      {"ssim", mean(all, [](const auto& score) { return Mean(score.map.ssim); })},
      {"lpips", mean(all, [](const auto& score) { return score.map.lpips; })},
      {"psnr_seeded_db",
       mean(all, [](const auto& score) { return score.seeded ? Mean(score.seeded->psnr_db) : Mean(); })},
      {"psnr_nearest_db", mean(all, [](const auto& score) { return Mean(score.nearest.psnr_db); })},
      {"psnr_with_shadows_db", mean(all, [](const auto& score) { return score.psnr_with_shadows_db; })},
      {"psnr_nearest_with_shadows_db",
       mean(all, [](const auto& score) { return score.psnr_nearest_with_shadows_db; })},
      {"views", nlohmann::json::array()}};
  for (const HeldOutScore& score : all) json["views"].push_back(to_json(score));
  return json;
}

}  // namespace edgesplat::quality
