// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "run_folder_maker.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "common/io/ply_points.hpp"
#include "common/io/trajectory_file.hpp"

#include <cmath>
#include <random>

namespace edgesplat::report {
namespace {

constexpr int kGroups = 200;  // 20 s at 10 Hz

Eigen::Vector3d position_at(double t) {
  return {1.2 * t, 3.0 * std::sin(0.25 * t), 0.6};
}

Status write_trajectories(const std::filesystem::path& folder) {
  std::vector<io::StampedPose> truth;
  std::vector<io::StampedPose> estimate;
  for (int i = 0; i < kGroups * 20; ++i) {
    const double t = 0.005 * i;
    io::StampedPose pose;
    pose.stamp = host_time_from_ns(1'000'000'000 + static_cast<std::int64_t>(i) * 5'000'000);
    pose.world_from_body.translation_m = position_at(t);
    truth.push_back(pose);
    if (i % 20 != 0) continue;
    pose.world_from_body.translation_m += Eigen::Vector3d(0.01 * t, 0.0, 0.03);
    estimate.push_back(pose);
  }
  EDGESPLAT_TRY_STATUS(io::write_tum(folder / "truth.tum", truth));
  return io::write_tum(folder / "robot" / "trajectory.tum", estimate);
}

Status write_groups(const std::filesystem::path& folder) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::string csv =
      "stamp_s,state,points_in_group,points_used,residual_rms_m,frozen_directions,weakest_signal,visual_"
      "patches,"
      "log_gain,lidar_delay_ms,track_ms,keyframe_ms,latency_ms\n";
  for (int i = 0; i < kGroups; ++i) {
    const double track_ms = 18.0 + 2.0 * normal(random) + (i % 50 == 0 ? 15.0 : 0.0);
    const double keyframe_ms = i % 5 == 0 ? 6.0 : 0.5;
    csv += std::to_string(1.0 + 0.1 * i) + "," +
           (i < 4                ? "initialising"
            : i >= 80 && i < 100 ? "degraded"
                                 : "tracking") +
           "," + std::to_string(20000 + i % 7 * 100) + "," + std::to_string(1800 + i % 11 * 10) + "," +
           std::to_string(0.012 + 0.001 * std::abs(normal(random))) +
           (i >= 80 && i < 100 ? ",1,1.2," : ",0,40,") + std::to_string(200 + i % 40) + ",0.05," + "0.000," +
           std::to_string(track_ms) + "," + std::to_string(keyframe_ms) + "," +
           std::to_string(track_ms + keyframe_ms + 4.0) + "\n";
  }
  return io::write_file_atomically(folder / "robot" / "groups.csv", csv);
}

/// A checked floor, two walls and a ceiling along x.
Status write_points(const std::filesystem::path& folder) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  io::PointCloud cloud;
  for (int i = 0; i < 200'000; ++i) {
    const float x = -2.0F + 28.0F * uniform(random);
    const float across = -4.5F + 9.0F * uniform(random);
    const float up = 2.6F * uniform(random);
    const bool odd = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(across))) % 2 != 0;
    if (i % 4 == 0) {
      cloud.points_m.emplace_back(x, across, 0.0F);
      cloud.rgb.push_back(odd ? std::array<std::uint8_t, 3>{150, 140, 120}
                              : std::array<std::uint8_t, 3>{90, 90, 95});
    } else if (i % 4 == 1) {
      cloud.points_m.emplace_back(x, across, 2.6F);
      cloud.rgb.push_back({255, 0, 255});
    } else {
      cloud.points_m.emplace_back(x, i % 4 == 2 ? -4.5F : 4.5F, up);
      cloud.rgb.push_back(i % 4 == 2 ? std::array<std::uint8_t, 3>{180, 90, 60}
                                     : std::array<std::uint8_t, 3>{60, 110, 170});
    }
  }
  return io::write_points_ply(folder / "robot" / "points.ply", cloud);
}

sensor::ImageRgb8 picture_of(int number, int offset) {
  sensor::ImageRgb8 image(640, 400);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      image.pixel(x, y)[0] = static_cast<std::uint8_t>(100 + offset + (x + 40 * number) % 100);
      image.pixel(x, y)[1] = static_cast<std::uint8_t>(80 + offset + y % 120);
      image.pixel(x, y)[2] = static_cast<std::uint8_t>(90 + offset);
    }
  }
  return image;
}

Status write_pictures(const std::filesystem::path& folder) {
  for (int number = 0; number < 12; ++number) {
    const std::string name = (number < 10 ? "00000" : "0000") + std::to_string(number);
    const auto keyframes = folder / "robot" / "keyframes";
    EDGESPLAT_TRY_STATUS(io::save_image(keyframes / (name + ".jpg"), picture_of(number, 0)));
    EDGESPLAT_TRY_STATUS(io::save_image(keyframes / (name + "_overlay.png"), picture_of(number, 20)));
    EDGESPLAT_TRY_STATUS(
        io::save_image(folder / "robot" / "renders" / (name + ".png"), picture_of(number, 5)));
    EDGESPLAT_TRY_STATUS(io::write_file_atomically(
        keyframes / (name + "_patches.csv"),
        std::string_view(
            "x_px,y_px,side_px,misfit,used\n40.0,30.0,8,0.40,1\n80.5,60.0,8,2.90,1\n20.0,50.0,8,15.00,0\n")));
  }
  return {};
}

/// 4 s LOCAL, 10 s FULL at 200 kB/s up, 6 s LEAN at 40 kB/s up; 90 kB/s down all the time.
Status write_modes(const std::filesystem::path& folder) {
  std::string text;
  double bytes_up = 0.0;
  for (int i = 0; i <= 40; ++i) {
    const double t_s = 0.5 * i;
    const bool full = t_s >= 4.0 && t_s < 14.0;
    const char* mode = full ? "FULL" : t_s < 4.0 ? "LOCAL" : "LEAN";
    text += std::string("{\"t_s\":") + std::to_string(t_s) + ",\"mode\":\"" + mode +
            "\",\"reason\":\"none\",\"render_p95_ms\":" + std::to_string(full ? 24.0 : 31.0) +
            ",\"memory_bytes\":" + std::to_string(2e8 + 2e6 * i) +
            ",\"bandwidth_bytes_per_s\":" + (i < 4 ? "null" : std::to_string(full ? 9.4e5 : 1.1e5)) +
            ",\"true_bandwidth_bytes_per_s\":" + std::to_string(full ? 1e6 : 1.2e5) +
            ",\"bytes_up\":" + std::to_string(bytes_up) + ",\"bytes_down\":" + std::to_string(45'000 * i) +
            ",\"gaussians\":" + std::to_string(1300 * i) + "}\n";
    bytes_up += full ? 100'000.0 : t_s < 4.0 ? 0.0 : 20'000.0;
  }
  return io::write_file_atomically(folder / "robot" / "modes.jsonl", text);
}

constexpr const char* kRobotMetrics = R"({
 "counters": {"livox.points.lost": 6, "livox.imu.lost": 1, "sync.late_points": 0, "tracking.coasted_groups": 2, "keyframes.made": 40, "pose_stream.poses": 3980,
   "link.bytes_up": 3000000, "map.hash_agreed": 17, "map.hash_disagreed": 0},
 "gauges": {"map.gaussians": 52000, "local.gaussians": 300},
 "histograms": {"tracking.group_ms": {"count": 200, "mean": 18.4, "min": 12.0, "p50": 18.1, "p95": 22.0, "p99": 33.0,
   "max": 36.0}, "pose_stream.latency_ms": {"count": 3980, "p50": 0.1, "p95": 0.6, "p99": 2.5}},
 "process": {"rss_bytes": 200000000, "peak_rss_bytes": 250000000, "cpu_s": 9.5}})";

}  // namespace

Status make_run_folder(const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  for (const char* sub : {"robot/keyframes", "robot/renders", "server"}) {
    std::filesystem::create_directories(folder / sub);
  }
  EDGESPLAT_TRY_STATUS(write_trajectories(folder));
  EDGESPLAT_TRY_STATUS(write_groups(folder));
  EDGESPLAT_TRY_STATUS(write_points(folder));
  EDGESPLAT_TRY_STATUS(write_pictures(folder));
  EDGESPLAT_TRY_STATUS(write_modes(folder));
  EDGESPLAT_TRY_STATUS(
      io::write_file_atomically(folder / "robot" / "metrics.json", std::string_view(kRobotMetrics)));
  EDGESPLAT_TRY_STATUS(
      io::write_file_atomically(folder / "server" / "metrics.json",
                                std::string_view(
                                    R"({"counters": {"ingest.chunks_rejected": 0, "ingest.duplicates": 3},
              "histograms": {"server.keyframe_to_delta_ms": {"count": 40, "p50": 80.0, "p95": 140.0}}, "process": {"peak_rss_bytes": 512000000}})")));
  EDGESPLAT_TRY_STATUS(
      io::write_file_atomically(folder / "rig.toml", std::string_view("name = \"<test & rig>\"\n")));
  return io::write_file_atomically(folder / "robot.toml", std::string_view("[tracking]\nvoxel_m = 0.5\n"));
}

}  // namespace edgesplat::report
