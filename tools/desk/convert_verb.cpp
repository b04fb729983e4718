// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/convert.hpp"
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

}  // namespace

void add_convert_verb(CLI::App& app, VerbContext& context) {
  auto* verb =
      app.add_subcommand("convert", "Write a map of Gaussians in another format: .ply, .spz, .splat");
  auto conversion = std::make_shared<Conversion>();
  auto json = std::make_shared<bool>(false);
  verb->add_option("in", conversion->in, "Map to read: .ply (INRIA or compressed), .spz or .splat")
      ->required();
  verb->add_option("out", conversion->out,
                   "Map to write: .ply (INRIA), .spz or .splat; OUT.json says what is in it")
      ->required();
  verb->add_option("--spz-version", conversion->spz_version, "Version of a .spz: 2, 3 or 4")
      ->check(CLI::Range(2, 4))
      ->capture_default_str();
  verb->add_flag("--json", *json, "Print one JSON line on stdout");
  verb->callback([conversion, json, &context] {
    context.work = [conversion, json] { return run_convert(*conversion, *json); };
  });
}

}  // namespace edgesplat::desk
