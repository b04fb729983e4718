// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/run_folder.hpp"

#include "common/io/atomic_file.hpp"

#include <algorithm>

namespace edgesplat::report {
namespace {

constexpr std::uint64_t kMaxTextBytes = std::uint64_t{256} << 20U;

/// Empty, and a sentence in `missing`, where the file cannot be read.
std::string text_of(const std::filesystem::path& path, std::vector<std::string>& missing) {
  auto text = io::read_text_file(path, kMaxTextBytes);
  if (text) return *std::move(text);
  missing.push_back(text.error().context);
  return {};
}

nlohmann::json json_of(const std::filesystem::path& path, std::vector<std::string>& missing) {
  const std::string text = text_of(path, missing);
  if (text.empty()) return nullptr;
  nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_object()) return json;
  missing.push_back(path.string() + " is not a JSON object");
  return nullptr;
}

std::filesystem::path existing(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? path : std::filesystem::path{};
}

std::vector<KeyframeFiles> find_keyframes(const std::filesystem::path& robot) {
  std::vector<KeyframeFiles> keyframes;
  std::error_code error;
  for (std::filesystem::directory_iterator it(robot / "keyframes", error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() != ".jpg") continue;
    const std::string number = it->path().stem().string();
    KeyframeFiles files{number, it->path(), existing(robot / "keyframes" / (number + "_overlay.png")),
                        existing(robot / "renders" / (number + ".png")),
                        existing(robot / "keyframes" / (number + "_patches.csv"))};
    if (files.overlay.empty() && files.render.empty()) continue;  // kept for scoring, not to be shown
    keyframes.push_back(std::move(files));
  }
  std::sort(keyframes.begin(), keyframes.end(),
            [](const KeyframeFiles& a, const KeyframeFiles& b) { return a.number < b.number; });
  return keyframes;
}

/// A run without a server has none: that is said in its section.
ModeTimeline modes_of(const std::filesystem::path& path, std::vector<std::string>& missing) {
  if (existing(path).empty()) return {};
  ModeTimeline modes = parse_mode_timeline(text_of(path, missing), "modes.jsonl");
  if (modes.skipped > 0) {
    missing.push_back(std::to_string(modes.skipped) + " lines of modes.jsonl, first " + modes.first_skipped);
  }
  return modes;
}

/// In the run's folder, or in the robot's where it wrote its own copy.
std::string toml_of(const std::filesystem::path& folder, const char* name,
                    std::vector<std::string>& missing) {
  const auto copy = existing(folder / "robot" / name);
  return text_of(copy.empty() ? folder / name : copy, missing);
}

}  // namespace

Result<RunFolder> read_run_folder(const std::filesystem::path& folder) {
  if (existing(folder).empty()) return fail(Errc::kNotFound, "there is no run folder " + folder.string());
  RunFolder run;
  run.folder = folder;
  const std::filesystem::path robot = folder / "robot";
  if (auto trajectory = io::read_tum(robot / "trajectory.tum")) {
    run.trajectory = *std::move(trajectory);
  } else {
    run.missing.push_back(trajectory.error().context);
  }
  const std::string groups = text_of(robot / "groups.csv", run.missing);
  if (auto table = CsvTable::parse(groups, "groups.csv")) {
    run.groups = *std::move(table);
  } else {
    run.missing.push_back(table.error().context);
  }
  run.robot_metrics = json_of(robot / "metrics.json", run.missing);
  run.server_metrics = json_of(folder / "server" / "metrics.json", run.missing);
  if (!existing(folder / "stream.json").empty()) run.stream = json_of(folder / "stream.json", run.missing);
  if (!existing(folder / "heldout.json").empty())
    run.held_out = json_of(folder / "heldout.json", run.missing);
  run.modes = modes_of(robot / "modes.jsonl", run.missing);
  run.keyframes = find_keyframes(robot);
  if (run.keyframes.empty()) run.missing.push_back("no camera pictures in " + (robot / "keyframes").string());
  if (auto points = io::read_points_ply(robot / "points.ply")) {
    run.points = *std::move(points);
  } else {
    run.missing.push_back(points.error().context);
  }
  run.rig_toml = toml_of(folder, "rig.toml", run.missing);
  run.robot_toml = toml_of(folder, "robot.toml", run.missing);
  return run;
}

}  // namespace edgesplat::report
