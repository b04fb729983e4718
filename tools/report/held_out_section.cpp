// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::string decibels(const nlohmann::json& view, const char* key) {
  return view.contains(key) && view[key].is_number() ? fmt::format("{:.1f} dB", view[key].get<double>())
                                                     : "-";
}

std::string row_of(const nlohmann::json& view, const std::filesystem::path& folder,
                   std::vector<std::string>& missing) {
  const std::string stem = view.value("pictures", std::string());
  const auto file = [&](const char* what) { return folder / (stem + "_" + what + ".png"); };
  std::vector<std::string> pieces = {
      figure(file("target"), "what should be seen", missing),
      figure(file("map"), "the robot's map: " + decibels(view, "psnr_db"), missing)};
  if (view.contains("psnr_seeded_db") && view["psnr_seeded_db"].is_number()) {
    pieces.push_back(
        figure(file("seeded"), "before optimising: " + decibels(view, "psnr_seeded_db"), missing));
  }
  pieces.push_back(
      figure(file("nearest"), "nearest keyframe's picture: " + decibels(view, "psnr_nearest_db"), missing));
  return html_picture_grid(pieces);
}

}  // namespace

std::string held_out_section(RunFolder& run, std::size_t limit) {
  if (!run.held_out.is_object() || !run.held_out.contains("views") || !run.held_out["views"].is_array())
    return "";
  const auto& views = run.held_out["views"];
  if (views.empty()) return "";
  std::string body = html_paragraph(fmt::format(
      "{} places between keyframes: what no training picture showed. Mean PSNR {} for the map, {} for "
      "the nearest keyframe's picture.",
      views.size(), decibels(run.held_out, "psnr_db"), decibels(run.held_out, "psnr_nearest_db")));
  const std::size_t count = std::min(limit, views.size());
  for (std::size_t i = 0; i < count; ++i) {
    body += row_of(views[(2 * i + 1) * views.size() / (2 * count)], run.folder / "heldout", run.missing);
  }
  return html_section("The map from unseen places", body);
}

}  // namespace edgesplat::report
