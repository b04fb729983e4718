// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cloud_picture.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_plot.hpp"

#include <fmt/format.h>

#include <limits>

namespace edgesplat::report {
namespace {

constexpr int kPictureWidth_px = 1000;
constexpr int kPictureHeight_px = 640;
constexpr float kAboveRobot_m = 1.0F;  // higher points would be ceilings and crowns

/// A little above the median height of the path.
CutAbove cut_of(const std::vector<io::StampedPose>& trajectory) {
  std::vector<double> heights_m;
  heights_m.reserve(trajectory.size());
  for (const io::StampedPose& pose : trajectory) heights_m.push_back(pose.world_from_body.translation_m.z());
  const auto median_m = percentile(std::move(heights_m), 0.5);
  return {median_m ? static_cast<float>(*median_m) + kAboveRobot_m : std::numeric_limits<float>::infinity()};
}

std::string top_view(const RunFolder& run, CutAbove cut) {
  const TopView view = draw_top_view(*run.points, cut, kPictureWidth_px);
  const auto uri = embed(view.picture, kPictureWidth_px);
  if (!uri) return html_paragraph(uri.error().context);
  Series path{"path of the robot", kRed, {}, {}};
  for (const io::StampedPose& pose : run.trajectory) {
    path.x.push_back(pose.world_from_body.translation_m.x());
    path.y.push_back(pose.world_from_body.translation_m.y());
  }
  Plot plot{"Map from above", "x (m)", "y (m)", {path}};
  plot.backdrop = Backdrop{*uri, view.x_min_m, view.x_max_m, view.y_min_m, view.y_max_m};
  plot.equal_scales = true;
  plot.height = 420;
  return draw(plot);
}

}  // namespace

std::string map_section(const RunFolder& run) {
  if (!run.points || run.points->points_m.empty()) {
    return html_section("Point map", html_paragraph("The run has no points.ply."));
  }
  const CutAbove cut = cut_of(run.trajectory);
  const auto oblique =
      embed(draw_oblique_view(*run.points, cut, kPictureWidth_px, kPictureHeight_px), kPictureWidth_px);
  std::string body = html_paragraph(fmt::format(
      "{} points{}. Points more than {:.0f} m above the robot are left out "
      "of the pictures, so that ceilings do not hide the rest.",
      run.points->points_m.size(),
      run.points->rgb.empty() ? ", coloured by height" : ", coloured by the camera", kAboveRobot_m));
  body += html_grid({top_view(run, cut), oblique ? html_picture(*oblique, "The same map from above a corner")
                                                 : html_paragraph(oblique.error().context)});
  return html_section("Point map", body);
}

}  // namespace edgesplat::report
