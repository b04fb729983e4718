// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"
#include "tools/desk/render_set.hpp"
#include "tools/desk/scene_files.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace edgesplat::desk {
namespace {

struct RenderOptions {
  std::string map;
  std::string cameras;
  std::string out;
  RenderSettings settings;
  bool json = false;
};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

Status run_render(const RenderOptions& options) {
  EDGESPLAT_TRY(const auto map, io::read_gaussians(options.map));
  EDGESPLAT_TRY(const SceneFiles scene, find_scene_files(options.cameras, {}));
  const io::CameraSet& cameras = scene.cameras;
  const SteadyClock clock;
  EDGESPLAT_TRY(const auto files, render_set(map, cameras, options.out, options.settings, clock));
  nlohmann::json pictures = nlohmann::json::array();
  std::vector<double> times_ms;
  for (const RenderedFile& file : files) {
    times_ms.push_back(file.render_ms);
    pictures.push_back({{"name", file.name},
                        {"file", file.file.string()},
                        {"width_px", file.width_px},
                        {"height_px", file.height_px},
                        {"render_ms", file.render_ms},
                        {"visible", file.visible}});
  }
  const double p50_ms = median(times_ms);
  if (options.json) {
    const nlohmann::json line = {{"map", options.map},
                                 {"gaussians", map.size()},
                                 {"render_ms_p50", p50_ms},
                                 {"render_ms_max", *std::ranges::max_element(times_ms)},
                                 {"pictures", pictures}};
    std::printf("%s\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    std::fprintf(stderr, "%zu pictures of %zu Gaussians in %s, %.1f ms each (median)\n", files.size(),
                 map.size(), options.out.c_str(), p50_ms);
  }
  return {};
}

}  // namespace

void add_render_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("render", "Draw a map of Gaussians as cameras would see it");
  auto options = std::make_shared<RenderOptions>();
  verb->add_option("--map", options->map, "Map: .ply, .spz or .splat")->required();
  verb->add_option("--cameras", options->cameras,
                   "Cameras: {\"cameras\": [...]} as common/io/camera_set.hpp has it, nerfstudio's "
                   "transforms.json, or "
                   "a scene's folder of nerfstudio's or COLMAP's")
      ->required();
  verb->add_option("--out", options->out, "Folder for <camera>.png")->required();
  verb->add_option("--scale", options->settings.scale, "Size of the pictures relative to the cameras'")
      ->check(CLI::Range(0.01, 4.0))
      ->capture_default_str();
  verb->add_option("--background", options->settings.background,
                   "Red, green and blue of what no Gaussian covers")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_flag("--antialiased", options->settings.antialiased,
                 "What is smaller than a pixel becomes fainter instead of brighter");
  verb->add_option("--least-axis", options->settings.least_axis_px,
                   "Pixels: of Gaussians that look smaller some are drawn as large as this, for all of them")
      ->check(CLI::Range(0.0, 10.0));
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_render(*options); }; });
}

}  // namespace edgesplat::desk
