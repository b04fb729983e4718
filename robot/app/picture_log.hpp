// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/app/render_loop.hpp"

#include <filesystem>
#include <fstream>

namespace edgesplat::app {

/// A line for each picture: when it began by the machine's steady clock, and how long it took. A disk that
/// takes nothing costs the file only. Single-owner.
class PictureLog {
 public:
  /// Empty: nothing is written.
  explicit PictureLog(const std::filesystem::path& path);
  void add(const PictureTimes& picture);

 private:
  std::ofstream file_;
};

}  // namespace edgesplat::app
