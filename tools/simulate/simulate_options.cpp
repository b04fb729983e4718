// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulate_options.hpp"

#include "common/config/config_file.hpp"

#include <Eigen/Geometry>

#include <numbers>
#include <sstream>
#include <utility>

namespace edgesplat::simulate {
namespace {

constexpr double kCameraPitch_rad = 3.0 * std::numbers::pi / 180.0;  // down

sensor::CameraMount camera_mount(const SimulateOptions& options) {
  sensor::CameraMount camera;
  geometry::CameraModel& model = camera.model;
  model.width_px = options.camera_width_px;
  model.height_px = options.camera_height_px;
  model.fx_px = 0.5 * options.camera_width_px;  // 90 degrees across
  model.fy_px = model.fx_px;
  model.cx_px = 0.5 * (options.camera_width_px - 1) + 0.7;  // no lens sits in the middle
  model.cy_px = 0.5 * (options.camera_height_px - 1) - 0.4;
  model.distortion = {-0.06, 0.01, 0.0004, -0.0003};
  Eigen::Matrix3d body_from_level_camera;  // columns: camera x right, y down, z forward
  body_from_level_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.body_from_camera.rotation = Eigen::Quaterniond(
      Eigen::AngleAxisd(kCameraPitch_rad, Eigen::Vector3d::UnitY()) * body_from_level_camera);
  camera.body_from_camera.translation_m = {0.09, 0.01, 0.13};
  camera.stamp_delay_s = options.camera_stamp_delay_s;
  return camera;
}

constexpr std::string_view name_of(LidarKind kind) {
  return kind == LidarKind::kMid360 ? "mid360" : "avia";
}

/// Where a further LiDAR sits: apart from the first, and turned, so that a wrong place would show.
geometry::RigidTransform further_place(std::size_t unit) {
  geometry::RigidTransform body_from_lidar;
  body_from_lidar.translation_m = {-0.30 * static_cast<double>(unit), unit % 2 == 1 ? 0.12 : -0.12, -0.06};
  body_from_lidar.rotation = Eigen::AngleAxisd(std::numbers::pi + 0.15, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  return body_from_lidar;
}

/// "mid360 avia"
void describe_more_lidars(config::ConfigReader& reader, std::vector<LidarKind>& kinds) {
  std::string names;
  for (const LidarKind kind : kinds) names += (names.empty() ? "" : " ") + std::string(name_of(kind));
  const std::string before = names;
  reader.field("more_lidars", names, "scan patterns of the LiDARs besides the first, with blanks between");
  if (names == before) return;
  kinds.clear();
  std::istringstream words(names);
  for (std::string word; words >> word;) {
    if (word != "mid360" && word != "avia")
      reader.problem("more_lidars", "\"" + word + "\" is none of mid360, avia");
    kinds.push_back(word == "avia" ? LidarKind::kAvia : LidarKind::kMid360);
  }
}

// The part of the options that decides what is measured, as TOML.
void describe_simulation(config::ConfigReader& reader, SimulateOptions& options) {
  using config::Range;
  reader.table("world", "what is simulated", [&] {
    WorldConfig& world = options.world;
    reader.field("name", world.name, "corridor, bare, loop, stairs, street, tunnel or square");
    reader.field("pedestrians", world.pedestrians, Range{0, 100}, "walking people");
    reader.field("cars", world.cars, Range{0, 50}, "moving cars");
    reader.field("seed", world.seed, Range<std::uint64_t>{0, ~0ULL}, "decides every texture, gait and noise");
  });
  reader.table("simulation", "how it is measured", [&] {
    reader.field("seconds", options.seconds, Range{0.0, 36000.0}, "length");
    reader.choice("lidar", options.lidar, {{"mid360", LidarKind::kMid360}, {"avia", LidarKind::kAvia}},
                  "scan pattern");
    describe_more_lidars(reader, options.more_lidars);
    reader.choice("clock", options.clock, {{"free", ClockMode::kFree}, {"ptp", ClockMode::kPtp}},
                  "of the devices");
    reader.field("body_motion", options.body_motion, Range{0.0, 10.0}, "scale of sway and bumps");
    reader.field("spin_radps", options.spin_radps, Range{0.0, 6.0}, "turning on itself while driving");
    reader.choice("lighting", options.lighting,
                  {{"steady", Lighting::kSteady}, {"failing", Lighting::kFailing}},
                  "of the camera's pictures");
  });
}

}  // namespace

Status validate(const SimulateOptions& options) {
  const auto refuse = [](const std::string& why) { return fail(Errc::kInvalidConfig, why); };
  if (!(options.seconds > 0.0 && options.seconds <= 36000.0)) {
    return refuse("--seconds must be in (0, 36000]");
  }
  const auto is_side = [](int px) { return px >= 32 && px <= 4096; };
  const bool no_camera = options.camera_width_px == 0 && options.camera_height_px == 0;
  if (!no_camera && !(is_side(options.camera_width_px) && is_side(options.camera_height_px))) {
    return refuse("--camera must be 0x0 (none) or WxH with sides of 32 to 4096 pixels");
  }
  if (!(options.camera_stamp_delay_s >= -0.1 && options.camera_stamp_delay_s <= 0.1)) {
    return refuse("--camera-stamp-delay must be in [-0.1, 0.1] s");
  }
  if (!(options.body_motion >= 0.0 && options.body_motion <= 10.0)) {
    return refuse("--body-motion must be in [0, 10]");
  }
  if (!(options.spin_radps >= 0.0 && options.spin_radps <= 6.0)) {
    return refuse("--spin must be in [0, 343] deg/s");
  }
  if (options.more_lidars.size() >= sensor::kMostLidars) {
    return refuse("--lidar: a robot has at most " + std::to_string(sensor::kMostLidars));
  }
  if (options.clean_views && no_camera) return refuse("--clean-views needs a camera");
  return {};
}

sensor::Rig simulated_rig(const SimulateOptions& options) {
  sensor::Rig rig;
  rig.name = "simulated";
  rig.lidar.name = name_of(options.lidar);
  rig.body_from_lidar.translation_m = {-0.011, -0.02329, 0.04412};  // Mid-360: where its own IMU sits
  for (const LidarKind kind : options.more_lidars) {
    sensor::LidarMount mount;
    mount.model.name = name_of(kind);
    mount.body_from_lidar = further_place(rig.lidar_count());
    rig.more_lidars.push_back(std::move(mount));
  }
  rig.imu = sensor::ImuModel{};
  if (options.camera_width_px > 0) rig.camera = camera_mount(options);
  return rig;
}

CameraSensorConfig simulated_exposure(const SimulateOptions& options) {
  CameraSensorConfig config;
  config.seed = options.world.seed;
  if (options.lighting == Lighting::kFailing) {
    constexpr double kFactors[] = {1.0, 0.35, 2.1, 0.6, 1.4};
    for (std::size_t k = 0; 2.0 * static_cast<double>(k) < options.seconds; ++k)
      config.exposure_steps.push_back({2.0 * static_cast<double>(k), kFactors[k % std::size(kFactors)]});
    for (double from_s = 7.0; from_s < options.seconds; from_s += 10.0) {
      config.light_steps.push_back({from_s, 0.0005});
      config.light_steps.push_back({from_s + 3.0, 1.0});
    }
    return config;
  }
  constexpr double kFactors[] = {1.0, 0.8, 1.15, 0.9};
  for (std::size_t k = 0; 5.0 * static_cast<double>(k) < options.seconds; ++k) {
    config.exposure_steps.push_back({5.0 * static_cast<double>(k), kFactors[k % std::size(kFactors)]});
  }
  return config;
}

std::string world_toml(const SimulateOptions& options) {
  SimulateOptions copy = options;
  return config::print_toml([&copy](config::ConfigReader& reader) { describe_simulation(reader, copy); });
}

Result<SimulateOptions> parse_world_toml(std::string_view text) {
  EDGESPLAT_TRY(const config::ConfigFile file, config::ConfigFile::parse(text, "world.toml"));
  SimulateOptions options;
  EDGESPLAT_TRY_STATUS(
      file.read([&options](config::ConfigReader& reader) { describe_simulation(reader, options); }));
  return options;
}

}  // namespace edgesplat::simulate
