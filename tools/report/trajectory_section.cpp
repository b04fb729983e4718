// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_plot.hpp"

#include <fmt/format.h>

namespace edgesplat::report {
namespace {

Plot path_plot(const Reference& reference) {
  Series truth{reference.name, kGreen, {}, {}, Series::Style::kLine, 5.0};  // to be seen under the estimate
  Series estimate{"estimate, aligned", kBlue, {}, {}};
  for (const accuracy::PosePair& pair : reference.pairs) {
    const Eigen::Vector3d aligned =
        reference.evaluation.reference_from_estimate * pair.estimate.translation_m;
    truth.x.push_back(pair.reference.translation_m.x());
    truth.y.push_back(pair.reference.translation_m.y());
    estimate.x.push_back(aligned.x());
    estimate.y.push_back(aligned.y());
  }
  Series start{"start", kOrange, {truth.x.front()}, {truth.y.front()}, Series::Style::kDots};
  Series end{"end", kPurple, {truth.x.back()}, {truth.y.back()}, Series::Style::kDots};
  Plot plot{"Path from above", "x (m)", "y (m)", {truth, estimate, start, end}};
  plot.equal_scales = true;
  plot.height = 380;
  return plot;
}

Plot error_plot(const Reference& reference) {
  std::vector<Series> axes = {{"x", kBlue, {}, {}}, {"y", kOrange, {}, {}}, {"z", kGreen, {}, {}}};
  for (const accuracy::PosePair& pair : reference.pairs) {
    const Eigen::Vector3d error = reference.evaluation.reference_from_estimate * pair.estimate.translation_m -
                                  pair.reference.translation_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis].x.push_back(to_seconds(pair.stamp - reference.pairs.front().stamp));
      axes[axis].y.push_back(100.0 * error[static_cast<Eigen::Index>(axis)]);
    }
  }
  Plot plot{"Position error after alignment", "time (s)", "error (cm)", std::move(axes)};
  plot.include_zero = true;
  return plot;
}

std::vector<std::string> figures(const Reference& reference) {
  const accuracy::Evaluation& e = reference.evaluation;
  return {reference.name,
          fmt::format("{}", e.pairs),
          fmt::format("{:.2f} m", e.path_m),
          fmt::format("{:.3f} m", e.absolute_m.rmse),
          fmt::format("{:.3f} m", e.absolute_m.median),
          fmt::format("{:.3f} m", e.absolute_m.max),
          fmt::format("{:.4f} m", e.per_metre.translation_m.mean),
          fmt::format("{:.3f} deg", e.per_metre.rotation_deg.mean),
          fmt::format("{:.3f} m ({:.2f} %)", e.end_to_end.distance_m, e.end_to_end.percent_of_path),
          e.kitti ? fmt::format("{:.2f} %", e.kitti->translation_percent) : "-"};
}

/// Without a reference the estimate alone.
std::string estimate_only(const RunFolder& run) {
  Series estimate{"estimate", kBlue, {}, {}};
  for (const io::StampedPose& pose : run.trajectory) {
    estimate.x.push_back(pose.world_from_body.translation_m.x());
    estimate.y.push_back(pose.world_from_body.translation_m.y());
  }
  Plot plot{"Path from above", "x (m)", "y (m)", {estimate}};
  plot.equal_scales = true;
  plot.height = 380;
  return html_paragraph("There is no reference for this run: its accuracy is not known.") +
         html_grid({draw(plot)});
}

}  // namespace

std::string trajectory_section(const RunFolder& run, const std::vector<Reference>& references) {
  if (run.trajectory.empty()) return html_section("Trajectory", html_paragraph("The run has no trajectory."));
  if (references.empty()) return html_section("Trajectory", estimate_only(run));
  std::vector<std::vector<std::string>> rows = {{"reference", "poses", "path", "ATE rmse", "ATE median",
                                                 "ATE max", "drift per metre", "turn per metre", "ETE",
                                                 "KITTI"}};
  for (const Reference& reference : references) rows.push_back(figures(reference));
  std::string body = html_table(rows);
  body += html_paragraph(
      "ATE: distance after the best rigid alignment of the whole path. Per metre: error of the motion over "
      "each "
      "metre. ETE: distance at the end when both start in the same pose, also as a share of the path. KITTI: "
      "mean "
      "drift over 100 to 800 m.");
  for (const Reference& reference : references) {
    body += html_grid({draw(path_plot(reference)), draw(error_plot(reference))});
  }
  return html_section("Trajectory", body);
}

}  // namespace edgesplat::report
