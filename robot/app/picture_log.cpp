// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/picture_log.hpp"

#include <cinttypes>
#include <cstdio>

namespace edgesplat::app {

PictureLog::PictureLog(const std::filesystem::path& path) {
  if (path.empty()) return;
  file_.open(path, std::ios::trunc);
  file_ << "began_s,took_ms\n";
}

void PictureLog::add(const PictureTimes& picture) {
  if (!file_) return;
  const std::int64_t began_us = to_ns(picture.began) / 1000;
  char line[64];
  std::snprintf(line, sizeof line, "%" PRId64 ".%06" PRId64 ",%.3f\n", began_us / 1'000'000,
                began_us % 1'000'000, picture.took_ms);
  file_ << line;
}

}  // namespace edgesplat::app
