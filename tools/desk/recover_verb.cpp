// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_recover.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace edgesplat::desk {
namespace {

struct RecoverOptions {
  std::filesystem::path recording;
  bool json = false;
};

Status run_recover(const RecoverOptions& options) {
  EDGESPLAT_TRY(const io::McapRecovery recovery, io::recover_mcap(options.recording));
  const auto& statistics = recovery.statistics;
  const double span_s = to_seconds(statistics.last_log_time - statistics.first_log_time);
  if (options.json) {
    const nlohmann::json figures = {{"was_whole", recovery.was_whole},
                                    {"messages", statistics.message_count},
                                    {"chunks", statistics.chunk_count},
                                    {"span_s", span_s},
                                    {"first_log_time_ns", to_ns(statistics.first_log_time)},
                                    {"last_log_time_ns", to_ns(statistics.last_log_time)},
                                    {"bytes_cut", recovery.bytes_cut},
                                    {"chunks_skipped", recovery.chunks_skipped},
                                    {"why", recovery.why}};
    std::printf("%s\n", figures.dump().c_str());
    return {};
  }
  if (recovery.was_whole) {
    std::fprintf(stderr, "%s is whole: nothing to do\n", options.recording.c_str());
    return {};
  }
  std::fprintf(stderr, "%s is whole again: %llu messages over %.2f s; cut off %llu bytes (%s)\n",
               options.recording.c_str(), static_cast<unsigned long long>(statistics.message_count), span_s,
               static_cast<unsigned long long>(recovery.bytes_cut), recovery.why.c_str());
  if (recovery.chunks_skipped > 0)
    std::fprintf(stderr, "%llu damaged chunks in between stay unread\n",
                 static_cast<unsigned long long>(recovery.chunks_skipped));
  return {};
}

}  // namespace

void add_recover_verb(CLI::App& app, VerbContext& context) {
  auto* verb =
      app.add_subcommand("recover", "Make a recording whole that a kill or a power cut ended, in place");
  auto options = std::make_shared<RecoverOptions>();
  verb->add_option("recording", options->recording, "The .mcap")->required();
  verb->add_flag("--json", options->json, "The result as one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_recover(*options); }; });
}

}  // namespace edgesplat::desk
