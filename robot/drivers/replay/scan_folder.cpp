// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/scan_folder.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "robot/drivers/replay/frame_times.hpp"
#include "robot/drivers/replay/kitti_calib.hpp"
#include "robot/drivers/replay/scan_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace edgesplat::replay {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{16} << 20U;
constexpr std::uintmax_t kMaxImageBytes = std::uintmax_t{64} << 20U;

/// One file to be replayed at its time.
struct Entry {
  nanoseconds time;  ///< of its arrival
  bool is_scan;
  fs::path path;
};

/// KITTI raw spins at 10 Hz and takes each picture when the scanner looks forward, in the middle of the turn.
constexpr nanoseconds kHalfTurn = std::chrono::milliseconds(50);

class ScanFolder final : public ReplaySource::Reader {
 public:
  ScanFolder(sensor::Rig rig, std::vector<Entry> entries, ReplayReport report)
      : rig_(std::move(rig)), entries_(std::move(entries)), report_(std::move(report)) {}

  [[nodiscard]] const sensor::Rig& rig() const override { return rig_; }
  [[nodiscard]] ReplayReport report() const override { return report_; }
  [[nodiscard]] nanoseconds duration() const override { return entries_.back().time - entries_.front().time; }
  [[nodiscard]] HostTime begin() const override { return HostTime(entries_.front().time); }
  [[nodiscard]] Result<std::optional<sensor::Measurement>> next() override;

 private:
  [[nodiscard]] Result<sensor::Measurement> read_scan(const Entry& entry);
  [[nodiscard]] sensor::LidarPacket as_turn(std::vector<sensor::LidarPoint> points,
                                            nanoseconds arrival) const;
  [[nodiscard]] Result<sensor::Measurement> read_frame(const Entry& entry);

  sensor::Rig rig_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
  std::uint32_t frame_number_ = 0;
  ReplayReport report_;
};

Result<std::optional<sensor::Measurement>> ScanFolder::next() {
  while (next_ < entries_.size()) {
    const Entry& entry = entries_[next_++];
    auto measurement = entry.is_scan ? read_scan(entry) : read_frame(entry);
    if (measurement) {
      ++report_.measurements;
      return *std::move(measurement);
    }
    if (measurement.error().code != Errc::kCorrupt) return tl::unexpected(std::move(measurement).error());
    report_.complete = false;
    ++(entry.is_scan ? report_.packets_refused : report_.frames_refused);
    if (report_.why.empty()) report_.why = measurement.error().context;
  }
  return std::nullopt;
}

Result<sensor::Measurement> ScanFolder::read_scan(const Entry& entry) {
  EDGESPLAT_TRY(const auto bytes, io::read_file(entry.path, kMaxScanFileBytes));
  sensor::LidarScan scan;
  EDGESPLAT_TRY(scan.points, parse_scan(bytes, entry.path.string(), report_.points_dropped));
  if (rig_.camera) return as_turn(std::move(scan.points), entry.time);
  scan.stamp = SensorTime(entry.time);
  scan.arrival = HostTime(entry.time);
  return scan;
}

/// A scan of the raw layout as one long packet: its rays carry no times, but the turn gives them (the scanner
/// turns clockwise seen from above, from rear to rear), so that groups can be cut where the pictures were
/// taken.
sensor::LidarPacket ScanFolder::as_turn(std::vector<sensor::LidarPoint> points, nanoseconds arrival) const {
  sensor::LidarPacket packet;
  packet.stamp = SensorTime(arrival - 2 * kHalfTurn);
  packet.arrival = HostTime(arrival);
  packet.stamp_source = sensor::StampSource::kPtp;
  packet.span = 2 * kHalfTurn;
  for (sensor::LidarPoint& point : points) {
    const double azimuth_rad = std::atan2(point.p_in_lidar_m.y(), point.p_in_lidar_m.x());
    const double turned = 0.5 * (1.0 - azimuth_rad / std::numbers::pi);
    point.offset_ns = static_cast<std::int32_t>(turned * static_cast<double>(packet.span.count()));
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.offset_ns < b.offset_ns; });
  packet.points = std::move(points);
  return packet;
}

Result<sensor::Measurement> ScanFolder::read_frame(const Entry& entry) {
  EDGESPLAT_TRY(const auto bytes, io::read_file(entry.path, kMaxImageBytes));
  auto image = io::decode_rgb8(bytes);
  if (!image) return fail(Errc::kCorrupt, entry.path.string() + ": " + image.error().context);
  const geometry::CameraModel& camera = rig_.camera->model;
  if (image->width_px != camera.width_px || image->height_px != camera.height_px)
    return fail(Errc::kCorrupt, entry.path.string() + " is " + std::to_string(image->width_px) + "x" +
                                    std::to_string(image->height_px) + " pixels, the first picture is " +
                                    std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px));
  sensor::CameraFrame frame;
  frame.stamp = SensorTime(entry.time);
  frame.arrival = HostTime(entry.time);
  frame.stamp_source = sensor::StampSource::kPtp;  // scans and pictures share one time line
  frame.sequence = frame_number_++;
  frame.image = std::make_shared<const sensor::ImageRgb8>(*std::move(image));
  return frame;
}

/// Files of a folder with one of these extensions, sorted by name; none where there is no such folder.
std::vector<fs::path> files_with(const fs::path& folder, std::initializer_list<std::string_view> extensions) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string extension = at->path().extension().string();
    if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
      files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What the folder holds, for messages: "README.md, velodyne/, ...".
std::string describe_content(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().filename().string() + (at->is_directory(error) ? "/" : ""));
  std::sort(names.begin(), names.end());
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > kShown) text += " and " + std::to_string(names.size() - kShown) + " more";
  return text.empty() ? "nothing" : text;
}

Result<std::vector<fs::path>> find_scans(const fs::path& folder) {
  for (const fs::path& place : {folder / "velodyne", folder}) {
    auto scans = files_with(place, {".bin"});
    if (!scans.empty()) return scans;
  }
  for (const fs::path& place : {folder / "velodyne", folder})
    if (const auto packed = files_with(place, {".mmx"}); !packed.empty())
      return fail(Errc::kInvalidArgument,
                  place.string() + " holds " + std::to_string(packed.size()) +
                      " packed scans (.mmx) and no .bin: unpack them first (tools/demo "
                      "does, or data/lidar_pack.py of the shared data)");
  return fail(Errc::kInvalidArgument,
              folder.string() +
                  " is no recording. Expected: a .mcap file; a folder with velodyne/*.bin "
                  "(and image_02/, calib_*.txt); or a folder of *.bin scans. Found: " +
                  describe_content(folder));
}

Result<FrameTimes> read_times(const fs::path& folder, const std::vector<fs::path>& scans) {
  std::vector<std::string> stems;
  stems.reserve(scans.size());
  for (const fs::path& scan : scans) stems.push_back(scan.stem().string());
  std::optional<std::vector<nanoseconds>> times;
  const fs::path path = folder / "times.txt";
  if (std::error_code error; fs::exists(path, error)) {
    EDGESPLAT_TRY(const std::string text, io::read_text_file(path, kMaxTextBytes));
    EDGESPLAT_TRY(times, parse_times(text, path.string()));
  }
  return FrameTimes::create(std::move(times), stems);
}

Result<sensor::CameraMount> read_camera(const fs::path& folder, const fs::path& first_image) {
  std::string text;
  std::string names;
  for (const fs::path& path : files_with(folder, {".txt"})) {
    if (!path.filename().string().starts_with("calib")) continue;
    EDGESPLAT_TRY(const std::string part, io::read_text_file(path, kMaxTextBytes));
    text += part + '\n';
    names += (names.empty() ? "" : " + ") + path.string();
  }
  if (names.empty())
    return fail(Errc::kInvalidArgument,
                folder.string() +
                    " has pictures in image_02/ but no calib_*.txt to say where the camera "
                    "is: add it, or move image_02/ away to replay the LiDAR alone");
  EDGESPLAT_TRY(const auto picture, io::read_file(first_image, kMaxImageBytes));
  const auto header = io::read_image_header(picture);
  if (!header) return fail(Errc::kCorrupt, first_image.string() + ": " + header.error().context);
  return parse_kitti_camera(text, names, header->width_px, header->height_px);
}

sensor::Rig velodyne_rig(const fs::path& folder) {
  sensor::Rig rig;
  rig.name = folder.filename().string();
  rig.lidar.name = "hdl64e";
  rig.lidar.bearing_sigma_rad = 0.0015;
  rig.lidar.min_range_m = 3.0;  // the car's own roof and bonnet
  rig.lidar.max_range_m = 100.0;
  return rig;
}

}  // namespace

bool holds_scans(const fs::path& folder) {
  return find_scans(folder).has_value();
}

Result<std::unique_ptr<ReplaySource::Reader>> open_scan_folder(const fs::path& folder) {
  EDGESPLAT_TRY(const auto scans, find_scans(folder));
  EDGESPLAT_TRY(const FrameTimes times, read_times(folder, scans));
  sensor::Rig rig = velodyne_rig(folder);
  std::vector<Entry> entries;
  for (const fs::path& path : scans) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error) return fail(Errc::kIo, "cannot read " + path.string() + ": " + error.message());
    EDGESPLAT_TRY_STATUS(check_scan_size(bytes, path.string()));
    if (const auto time = times.of(path.stem().string())) entries.push_back({*time, true, path});
  }
  ReplayReport report;
  const auto images = files_with(folder / "image_02", {".jpg", ".jpeg", ".png"});
  if (!images.empty()) {
    EDGESPLAT_TRY(rig.camera, read_camera(folder, images.front()));
    for (const fs::path& path : images) {
      if (const auto time = times.of(path.stem().string())) {
        entries.push_back({*time, false, path});
      } else {
        report.complete = false;
        ++report.frames_refused;
        report.why = path.string() + " has no time: no line in times.txt, or no scan of its number";
      }
    }
  }
  if (rig.camera) {
    for (Entry& entry : entries) entry.time += entry.is_scan ? kHalfTurn : nanoseconds(0);
  }
  if (entries.empty())
    return fail(Errc::kInvalidArgument, folder.string() + ": no scan has a time in times.txt");
  const auto earlier = [](const Entry& a, const Entry& b) { return a.time < b.time; };
  std::stable_sort(entries.begin(), entries.end(), earlier);
  return std::unique_ptr<ReplaySource::Reader>(
      std::make_unique<ScanFolder>(std::move(rig), std::move(entries), std::move(report)));
}

}  // namespace edgesplat::replay
