// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"
#include "common/thread/write_signals.hpp"
#include "robot/app/options.hpp"
#include "robot/app/run.hpp"

#include <cstdio>

int main(int argc, char** argv) {
  using namespace edgesplat;
  const app::ParsedOptions parsed = app::parse_options(argc, argv);
  if (parsed.exit_now) return *parsed.exit_now;
  thread::make_write_signals_errors();
  const thread::StopSignal stop_signal;
  const Status status = app::run_robot(parsed.options, stop_signal.token());
  if (status) return 0;
  std::fprintf(stderr, "edgesplat-robot: %s\n", status.error().context.c_str());
  return exit_code(status.error());
}
