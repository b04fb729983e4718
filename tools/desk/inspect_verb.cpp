// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/inspection.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace edgesplat::desk {
namespace {

struct InspectOptions {
  std::string file;
  std::string attachment;
  std::string target;
  bool json = false;
};

Status run_inspect(const InspectOptions& options) {
  if (!options.attachment.empty()) {
    return extract_attachment(options.file, options.attachment, options.target);
  }
  EDGESPLAT_TRY(const Inspection inspection, inspect_file(options.file));
  if (options.json) {
    std::printf("%s\n", inspection.json.c_str());
  } else {
    std::fputs(inspection.text.c_str(), stderr);
  }
  return {};
}

}  // namespace

void add_inspect_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("inspect", "Say what a recording, point cloud, map or trajectory holds");
  auto options = std::make_shared<InspectOptions>();
  verb->add_option("file", options->file, "A .mcap, .bag, .db3, .ply, .spz, .splat or .tum file")->required();
  auto* extract =
      verb->add_option("--extract", options->attachment, "Take this attachment out of a recording");
  auto* to = verb->add_option("--to", options->target, "Where the attachment goes");
  extract->needs(to);
  to->needs(extract);
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_inspect(*options); }; });
}

}  // namespace edgesplat::desk
