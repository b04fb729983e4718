// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/trajectory_file.hpp"
#include "tools/desk/gap_statistics.hpp"
#include "tools/desk/inspection.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace edgesplat::desk {

Result<Inspection> inspect_trajectory(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto poses, io::read_tum(path));
  GapStatistics stamps;
  double path_m = 0.0;
  std::size_t steps_back = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    stamps.add(poses[i].stamp);
    if (i == 0) continue;
    path_m += (poses[i].world_from_body.translation_m - poses[i - 1].world_from_body.translation_m).norm();
    if (poses[i].stamp < poses[i - 1].stamp) ++steps_back;
  }
  const nlohmann::json json = {{"kind", "trajectory"},
                               {"poses", poses.size()},
                               {"duration_s", stamps.duration_s()},
                               {"path_m", path_m},
                               {"rate_hz", stamps.rate_hz()},
                               {"largest_gap_s", stamps.largest_gap_s()},
                               {"steps_back_in_time", steps_back}};
  std::string text =
      fmt::format("{} poses over {:.2f} s and {:.2f} m, {:.2f} Hz, largest gap {:.3f} s (at {} s)\n",
                  poses.size(), stamps.duration_s(), path_m, stamps.rate_hz(), stamps.largest_gap_s(),
                  io::format_decimal_seconds(stamps.gap_start()));
  if (steps_back > 0) text += fmt::format("not in time order: {} steps back\n", steps_back);
  return Inspection{text, json.dump()};
}

}  // namespace edgesplat::desk
