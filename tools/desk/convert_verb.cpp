// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/convert.hpp"
#include "tools/desk/export_scene.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace edgesplat::desk {
namespace {

Status run_convert(const Conversion& conversion, bool json) {
  EDGESPLAT_TRY(const ConversionReport report, convert_map(conversion));
  if (json) {
    const nlohmann::json line = {
        {"in", conversion.in.string()},          {"out", conversion.out.string()},
        {"gaussians", report.gaussians},         {"sh_degree_in", report.sh_degree_in},
        {"sh_degree_out", report.sh_degree_out}, {"bytes_in", report.bytes_in},
        {"bytes_out", report.bytes_out},         {"position_error_max", report.position_error_max},
        {"frame", report.sidecar.frame},         {"stored_as", report.sidecar.stored_as}};
    std::printf("%s\n", line.dump().c_str());
    return {};
  }
  std::fprintf(stderr, "%s: %llu Gaussians, SH degree %d, %.2f MB (from %.2f MB)\n", conversion.out.c_str(),
               static_cast<unsigned long long>(report.gaussians), report.sh_degree_out,
               1e-6 * static_cast<double>(report.bytes_out), 1e-6 * static_cast<double>(report.bytes_in));
  if (report.sh_degree_out < report.sh_degree_in) {
    std::fprintf(stderr, "the format holds SH of degree %d at most: degree %d was left out\n",
                 report.sh_degree_out, report.sh_degree_in);
  }
  return {};
}

Status run_export(const SceneExport& options, bool json) {
  EDGESPLAT_TRY(const SceneExportReport report, export_scene(options));
  if (json) {
    const nlohmann::json line = {{"in", options.recording.string()},
                                 {"out", options.folder.string()},
                                 {"pictures", report.pictures},
                                 {"points", report.points}};
    std::printf("%s\n", line.dump().c_str());
    return {};
  }
  std::fprintf(stderr, "%s: %zu pictures with depth, %zu points\n", options.folder.c_str(), report.pictures,
               report.points);
  return {};
}

struct ConvertVerbOptions {
  Conversion map;
  SceneExport scene;
  bool json = false;
};

Status run(const ConvertVerbOptions& options) {
  if (options.map.in.extension() != ".mcap") return run_convert(options.map, options.json);
  SceneExport scene = options.scene;
  scene.recording = options.map.in;
  scene.folder = options.map.out;
  return run_export(scene, options.json);
}

}  // namespace

void add_convert_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("convert",
                                  "Write a map of Gaussians in another format: .ply, .spz, .splat; or a "
                                  "simulated recording as a scene to train on");
  auto options = std::make_shared<ConvertVerbOptions>();
  verb->add_option("in", options->map.in,
                   "Map to read: .ply (INRIA or compressed), .spz or .splat; or a simulated recording, .mcap")
      ->required();
  verb->add_option("out", options->map.out,
                   "Map to write: .ply (INRIA), .spz or .splat; OUT.json says what is in it. Of a recording: "
                   "folder for pictures without movers, depth, points and transforms.json (nerfstudio)")
      ->required();
  verb->add_option("--spz-version", options->map.spz_version, "Version of a .spz: 2, 3 or 4")
      ->check(CLI::Range(2, 4))
      ->capture_default_str();
  verb->add_option("--pictures", options->scene.pictures, "Of a recording: so many at most, evenly over it")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  verb->add_option("--points", options->scene.points, "Of a recording: size of the point cloud at most")
      ->capture_default_str();
  verb->add_option("--seed", options->scene.seed, "Of a recording: decides which pixels become points")
      ->capture_default_str();
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run(*options); }; });
}

}  // namespace edgesplat::desk
