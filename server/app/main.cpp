// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/link/dds_transport.hpp"
#include "common/link/link_metrics.hpp"
#include "common/log/log.hpp"
#include "common/thread/write_signals.hpp"
#include "server/app/options.hpp"
#include "server/app/server.hpp"
#include "server/app/service_notify.hpp"
#include "server/app/unsaved_keyframes.hpp"
#include "server/store/map_folder.hpp"
#include "server/stream/epoch_file.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace {

using namespace edgesplat;

/// A thread of the server that has not come round for so long hangs.
constexpr nanoseconds kHung = std::chrono::seconds(10);

/// SIGTERM and SIGINT, kept for sigtimedwait: to be blocked before any thread starts.
sigset_t block_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

/// True when an end signal came within `timeout`.
bool wait_for_end(const sigset_t& signals, nanoseconds timeout) {
  const timespec wait{timeout.count() / 1'000'000'000, timeout.count() % 1'000'000'000};
  return sigtimedwait(&signals, nullptr, &wait) > 0;
}

Status make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(Errc::kIo, "cannot create " + folder.string() + ": " + error.message());
  return {};
}

/// Maps of earlier servers; what cannot be read is said and left where it is.
Result<std::vector<store::StoredMap>> load_maps(const std::filesystem::path& folder, std::size_t max_robots) {
  EDGESPLAT_TRY(auto found, store::load_newest_maps(folder, max_robots));
  for (const store::RefusedMap& refused : found.refused)
    EDGESPLAT_LOG_ERROR("store", "map refused", "why", refused.error.context);
  std::vector<store::StoredMap> maps;
  for (store::LoadedMap& loaded : found.maps) {
    const store::LoadReport& report = loaded.report;
    EDGESPLAT_LOG_INFO("store", report.whole() ? "map loaded" : "damaged map recovered", "robot",
                       loaded.map.robot.value, "gaussians", loaded.map.gaussians.size(), "lost",
                       report.gaussians_lost, "rounded", report.gaussians_rounded);
    maps.push_back(std::move(loaded.map));
  }
  return maps;
}

/// Keyframes that no saved map has; a log that cannot be read costs them, not the start.
std::vector<ingest::IngestedKeyframe> load_unsaved(const std::filesystem::path& folder,
                                                   std::span<const store::StoredMap> maps) {
  const auto logged = store::read_newest_keyframes(folder);
  if (!logged) {
    EDGESPLAT_LOG_ERROR("store", "keyframe log not read", "why", logged.error().context);
    return {};
  }
  auto unsaved = app::unsaved_keyframes(*logged, maps);
  EDGESPLAT_LOG_INFO("store", "keyframe log read", "keyframes", logged->size(), "unsaved", unsaved.size());
  return unsaved;
}

store::RecorderConfig recorder_config(const config::StoreConfig& config,
                                      const std::filesystem::path& folder) {
  store::RecorderConfig recorder;
  recorder.folder = folder;
  recorder.log.max_bytes = std::uint64_t{config.max_megabytes} * 1'000'000;
  recorder.queue_keyframes = config.queue_keyframes;
  return recorder;
}

void say(const Status& told) {
  if (!told) EDGESPLAT_LOG_WARN("server", "service manager not told", "why", told.error().context);
}

void run_until_end(app::Server& server, const app::Options& options, const sigset_t& signals,
                   const app::ServiceNotify& notify) {
  const nanoseconds period = from_seconds(options.config.heartbeat_period_s);
  while (!wait_for_end(signals, period)) {
    server.send_heartbeats();
    if (server.without_progress() < kHung) say(notify.watchdog());
    if (options.idle_exit_s && server.idle() >= from_seconds(*options.idle_exit_s)) {
      EDGESPLAT_LOG_INFO("server", "idle: ending", "idle_exit_s", *options.idle_exit_s);
      return;
    }
  }
  EDGESPLAT_LOG_INFO("server", "asked to end");
}

Status run(const app::Options& options) {
  const sigset_t signals = block_end_signals();
  const auto folder = options.out / "server";
  EDGESPLAT_TRY_STATUS(make_folder(folder));
  const SteadyClock clock;
  metrics::Registry registry;
  EDGESPLAT_TRY(auto domain, link::DdsDomain::open(options.config.link));
  link::DdsTransportOptions transport_options;
  transport_options.role = link::Role::kServer;
  EDGESPLAT_TRY(const auto transport, link::open_dds_transport(std::move(domain), transport_options, clock));
  app::Start start;
  std::optional<store::Recorder> recorder;
  if (options.config.store.enabled) {
    const auto store_folder = folder / options.config.store.folder;
    EDGESPLAT_TRY(start.maps, load_maps(store_folder, options.config.max_robots));
    start.unsaved = load_unsaved(store_folder, start.maps);
    start.recorder = &recorder.emplace(recorder_config(options.config.store, store_folder), registry, clock);
  }
  map::Epoch known;
  for (const store::StoredMap& map : start.maps) known = std::max(known, map.epoch);
  EDGESPLAT_TRY(start.epoch, stream::next_epoch(folder / "epoch", known));
  const map::Epoch epoch = start.epoch;
  app::Server server(options.config, std::move(start), *transport, registry, clock);
  EDGESPLAT_LOG_INFO("server", "ready", "epoch", epoch.value, "interface", options.config.link.interface,
                     "domain", options.config.link.domain, "out", folder.string());
  const auto notify = app::ServiceNotify::from_environment();
  say(notify.ready());
  run_until_end(server, options, signals, notify);
  say(notify.stopping());
  server.finish(std::chrono::seconds(2));
  link::record(registry, *transport);
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(folder / "metrics.json", registry.to_json()));
  for (const gaussian::GaussianCloud* seeds : server.seeds()) {
    EDGESPLAT_TRY_STATUS(io::write_gaussians_ply(folder / "seeded.ply", *seeds));
  }
  for (const app::MapStatus& status : server.status()) {
    EDGESPLAT_LOG_INFO("server", "map", "robot", status.robot.value, "gaussians", status.gaussians, "seq",
                       status.seq, "hash", status.map_hash);
  }
  return recorder ? recorder->outcome() : Status{};
}

}  // namespace

int main(int argc, char** argv) {
  const auto options = app::parse_options(argc, argv);
  if (!options) {
    std::fprintf(stderr, "edgesplat-server: %s\n", options.error().context.c_str());
    return exit_code(options.error());
  }
  if (const auto level = log::parse_level(options->config.log_level)) log::set_level(*level);
  switch (options->action) {
    case app::Options::Action::kDone:
      return 0;
    case app::Options::Action::kCheckConfig:
      std::fprintf(stderr, "edgesplat-server: configuration is valid\n");
      return 0;
    case app::Options::Action::kPrintConfig:
      std::fputs(config::to_toml(options->config).c_str(), stdout);
      return 0;
    case app::Options::Action::kRun:
      break;
  }
  thread::make_write_signals_errors();
  const Status status = run(*options);
  if (status) return 0;
  std::fprintf(stderr, "edgesplat-server: %s\n", status.error().context.c_str());
  return exit_code(status.error());
}
