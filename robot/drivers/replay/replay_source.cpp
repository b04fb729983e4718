// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/replay_source.hpp"

#include "common/io/bag_mcap.hpp"
#include "common/io/bag_source.hpp"
#include "common/io/mcap_reader.hpp"
#include "robot/drivers/replay/bag_topics.hpp"
#include "robot/drivers/replay/mcap_recording.hpp"
#include "robot/drivers/replay/ros_recording.hpp"
#include "robot/drivers/replay/scan_folder.hpp"

#include <system_error>
#include <utility>

namespace edgesplat::replay {

namespace {

struct Opened {
  std::unique_ptr<ReplaySource::Reader> reader;
  bool uses_rig = false;  ///< the reader's rig is the given one
};

Result<Opened> open_ros(std::unique_ptr<io::BagSource> bag, const std::filesystem::path& path,
                        const std::optional<BagRig>& rig) {
  if (!rig)
    return fail(
        Errc::kInvalidConfig,
        path.string() +
            " is a recording of ROS, which does not say what its sensors are and where they sit: give "
            "--rig FILE (robot/config/rigs has some); it holds " +
            list_topics(bag->topics()));
  auto reader = open_ros_recording(std::move(bag), *rig);
  if (!reader) return fail(reader.error().code, path.string() + ": " + reader.error().context);
  return Opened{*std::move(reader), true};
}

Result<Opened> open_mcap(const std::filesystem::path& path, const std::optional<BagRig>& rig) {
  EDGESPLAT_TRY(io::McapReader file, io::McapReader::open(path));
  if (rig && !is_own_recording(file)) return open_ros(io::to_mcap_bag(std::move(file)), path, rig);
  EDGESPLAT_TRY(auto reader, open_mcap_recording(std::move(file), path));
  return Opened{std::move(reader)};
}

Result<Opened> open_path(const std::filesystem::path& path, const std::optional<BagRig>& rig) {
  if (ReplaySource::is_scan_folder(path)) {
    EDGESPLAT_TRY(auto reader, open_scan_folder(path));
    return Opened{std::move(reader)};
  }
  if (path.extension() == ".mcap" && !std::filesystem::is_directory(path)) return open_mcap(path, rig);
  if (!io::is_bag(path)) {
    return fail(
        Errc::kInvalidArgument,
        path.string() +
            " is no recording: expected a .mcap, .bag or .db3 file, a folder with velodyne/*.bin "
            "(and image_02/, calib_*.txt) or a folder of *.bin scans; found a file " +
            (path.has_extension() ? "*" + path.extension().string() : std::string("without extension")));
  }
  EDGESPLAT_TRY(auto bag, io::open_bag(path));
  return open_ros(std::move(bag), path, rig);
}

}  // namespace

ReplaySource::ReplaySource(std::unique_ptr<Reader> reader, std::optional<sensor::Rig> rig)
    : reader_(std::move(reader)), rig_(std::move(rig)) {}
ReplaySource::ReplaySource(ReplaySource&&) noexcept = default;
ReplaySource& ReplaySource::operator=(ReplaySource&&) noexcept = default;
ReplaySource::~ReplaySource() = default;

bool ReplaySource::is_scan_folder(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error) && (holds_scans(path) || !io::is_bag(path));
}

Result<ReplaySource> ReplaySource::open(const std::filesystem::path& path, const std::optional<BagRig>& rig) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error);
  if (kind.type() == std::filesystem::file_type::not_found)
    return fail(
        Errc::kNotFound,
        path.string() + " does not exist; give a .mcap, .bag or .db3 recording or a folder of LiDAR scans");
  if (error) return fail(Errc::kIo, "cannot look at " + path.string() + ": " + error.message());
  EDGESPLAT_TRY(Opened opened, open_path(path, rig));
  std::optional<sensor::Rig> instead;
  if (rig && !opened.uses_rig) instead = rig->rig;
  return ReplaySource(std::move(opened.reader), std::move(instead));
}

const sensor::Rig& ReplaySource::rig() const {
  return rig_ ? *rig_ : reader_->rig();
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
