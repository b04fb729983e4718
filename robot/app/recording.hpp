// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/thread/worker.hpp"
#include "robot/drivers/replay/recorder.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace edgesplat::app {

/// `--record`: a recorder with the thread that writes it. A write error (disk full) is logged once and ends
/// the recording, never the run. Owned by one thread.
class Recording {
 public:
  /// kIo where the file cannot be created.
  static Result<std::unique_ptr<Recording>> start(const std::filesystem::path& path,
                                                  const std::string& rig_toml, const std::string& robot_toml,
                                                  const replay::RecorderConfig& config = {});
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() = default;

  [[nodiscard]] replay::Recorder* recorder() { return recorder_.get(); }
  /// Writes what waits and closes the file. Errors: kIo where the file is not whole.
  [[nodiscard]] Status finish(metrics::Registry& metrics);

 private:
  explicit Recording(std::unique_ptr<replay::Recorder> recorder);
  bool write_step(const std::stop_token& stop);

  std::unique_ptr<replay::Recorder> recorder_;
  std::optional<thread::Worker> writer_;
};

}  // namespace edgesplat::app
