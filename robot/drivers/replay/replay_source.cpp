// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/replay_source.hpp"

#include "robot/drivers/replay/mcap_recording.hpp"
#include "robot/drivers/replay/scan_folder.hpp"

#include <system_error>
#include <utility>

namespace edgesplat::replay {

ReplaySource::ReplaySource(std::unique_ptr<Reader> reader) : reader_(std::move(reader)) {}
ReplaySource::ReplaySource(ReplaySource&&) noexcept = default;
ReplaySource& ReplaySource::operator=(ReplaySource&&) noexcept = default;
ReplaySource::~ReplaySource() = default;

Result<ReplaySource> ReplaySource::open(const std::filesystem::path& path) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error);
  if (kind.type() == std::filesystem::file_type::not_found)
    return fail(Errc::kNotFound,
                path.string() + " does not exist; give a .mcap recording or a folder of LiDAR scans");
  if (error) return fail(Errc::kIo, "cannot look at " + path.string() + ": " + error.message());
  if (std::filesystem::is_directory(kind)) {
    EDGESPLAT_TRY(auto reader, open_scan_folder(path));
    return ReplaySource(std::move(reader));
  }
  if (path.extension() != ".mcap")
    return fail(
        Errc::kInvalidArgument,
        path.string() +
            " is no recording: expected a .mcap file, a folder with velodyne/*.bin "
            "(and image_02/, calib_*.txt) or a folder of *.bin scans; found a file " +
            (path.has_extension() ? "*" + path.extension().string() : std::string("without extension")));
  EDGESPLAT_TRY(auto reader, open_mcap_recording(path));
  return ReplaySource(std::move(reader));
}

const sensor::Rig& ReplaySource::rig() const {
  return reader_->rig();
}
Result<std::optional<sensor::Measurement>> ReplaySource::next() {
  return reader_->next();
}
ReplayReport ReplaySource::report() const {
  return reader_->report();
}
nanoseconds ReplaySource::duration() const {
  return reader_->duration();
}
HostTime ReplaySource::begin() const {
  return reader_->begin();
}

}  // namespace edgesplat::replay
