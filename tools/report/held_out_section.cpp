// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/run_metrics.hpp"
#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace edgesplat::report {
namespace {

constexpr int kPictureWidth_px = 480;

std::string figure(const std::filesystem::path& path, const std::string& caption,
                   std::vector<std::string>& missing) {
  const auto uri = embed_file(path, kPictureWidth_px);
  if (uri) return html_picture(*uri, caption);
  missing.push_back(uri.error().context);
  return html_paragraph(caption + ": not there");
}

std::string decibels(const nlohmann::json& json, const char* key) {
  const auto psnr_db = number_of(json, key);
  return psnr_db ? fmt::format("{:.1f} dB", *psnr_db) : "-";
}

std::string percent(const nlohmann::json& json, const char* key) {
  const auto share = number_of(json, key);
  return share ? fmt::format("{:.0f} %", 100.0 * *share) : "-";
}

bool is_real(const nlohmann::json& held_out) {
  return held_out.contains("kind") && held_out["kind"] == "real";
}

/// "", or " in 2 blocks".
std::string in_blocks(const nlohmann::json& views) {
  std::set<double> blocks;
  for (const auto& view : views) {
    if (const auto block = number_of(view, "block")) blocks.insert(*block);
  }
  if (blocks.empty()) return "";
  return fmt::format(" in {} {}", blocks.size(), blocks.size() == 1 ? "block" : "blocks");
}

/// What the figures are where shadows of movers count too, which no map without movers can show.
std::string with_shadows(const nlohmann::json& held_out) {
  if (!number_of(held_out, "psnr_with_shadows_db")) return "";
  return fmt::format(
      " What can move does not count, nor the ground close to it, for its shadow; with the shadows counting: "
      "map "
      "{}, nearest training picture {}.",
      decibels(held_out, "psnr_with_shadows_db"), decibels(held_out, "psnr_nearest_with_shadows_db"));
}

std::string words_of(const nlohmann::json& held_out) {
  const auto& views = held_out["views"];
  const std::string map = decibels(held_out, "psnr_db"), nearest = decibels(held_out, "psnr_nearest_db");
  if (!is_real(held_out)) {
    return fmt::format(
        "{} places between keyframes: what no training picture showed. Mean PSNR {} for the map, {} for "
        "the nearest keyframe's picture.",
        views.size(), map, nearest);
  }
  const bool masked = held_out.contains("movers_masked") && held_out["movers_masked"] == true;
  return fmt::format(
             "{} pictures held out of mapping{}, from the poses at which they were tracked. Mean PSNR "
             "over {}: map {}, nearest training picture {}.",
             views.size(), in_blocks(views),
             masked ? "the " + percent(held_out, "static_share") + " static pixels"
                    : "all pixels, movers included for want of a segmentation model",
             map, nearest) +
         with_shadows(held_out);
}

std::string row_of(const nlohmann::json& view, bool real, const std::filesystem::path& folder,
                   std::vector<std::string>& missing) {
  const std::string stem = view.value("pictures", std::string());
  const auto file = [&](const char* what) { return folder / (stem + "_" + what + ".png"); };
  std::vector<std::string> pieces = {
      figure(file("target"), real ? "what the camera saw, held out" : "what should be seen", missing),
      figure(file("map"), "the robot's map: " + decibels(view, "psnr_db"), missing)};
  if (number_of(view, "psnr_seeded_db")) {
    pieces.push_back(
        figure(file("seeded"), "before optimising: " + decibels(view, "psnr_seeded_db"), missing));
  }
  pieces.push_back(
      figure(file("nearest"), "nearest keyframe's picture: " + decibels(view, "psnr_nearest_db"), missing));
  if (real) {
    pieces.push_back(
        figure(file("weight"), "what counts, in white: " + percent(view, "static_share"), missing));
  }
  return html_picture_grid(pieces);
}

}  // namespace

std::string held_out_section(RunFolder& run, std::size_t limit) {
  if (!run.held_out.is_object() || !run.held_out.contains("views") || !run.held_out["views"].is_array())
    return "";
  const auto& views = run.held_out["views"];
  if (views.empty()) return "";
  std::string body = html_paragraph(words_of(run.held_out));
  const bool real = is_real(run.held_out);
  const std::size_t count = std::min(limit, views.size());
  for (std::size_t i = 0; i < count; ++i) {
    body +=
        row_of(views[(2 * i + 1) * views.size() / (2 * count)], real, run.folder / "heldout", run.missing);
  }
  return html_section("The map from unseen places", body);
}

}  // namespace edgesplat::report
