// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulator.hpp"

#include "common/io/recording_topics.hpp"
#include "common/sensor/rig_config.hpp"
#include "tools/simulate/recording_writer.hpp"
#include "tools/simulate/trajectory.hpp"
#include "tools/simulate/virtual_camera.hpp"
#include "tools/simulate/virtual_lidar.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::simulate {
namespace {

double driven_between(const Trajectory& trajectory, double begin_s, double end_s) {
  return (trajectory.world_from_body(end_s).translation_m - trajectory.world_from_body(begin_s).translation_m)
      .norm();
}

// Steps of 0.1 s: the LiDAR's and the IMU's part, then the frame exposed in the middle of the step.
Status run_steps(const World& world, const Trajectory& trajectory, const SimulateOptions& options,
                 RecordingWriter& recording, const std::function<bool(double)>& after_step,
                 SimulateReport& report) {
  std::vector<VirtualLidar> lidars;
  for (std::size_t unit = 0; unit <= options.more_lidars.size(); ++unit)
    lidars.emplace_back(world, trajectory, options, unit);
  std::optional<VirtualCamera> camera;
  if (options.camera_width_px > 0) camera.emplace(world, trajectory, options);
  double begin_s = 0.0;
  for (int step = 1; begin_s < options.seconds && !report.stopped; ++step) {
    const double end_s = std::min(step * kFramePeriod_s, options.seconds);
    for (VirtualLidar& lidar : lidars) lidar.measure_until(end_s, recording);
    if (camera && end_s - begin_s > 0.5 * kFramePeriod_s) {
      EDGESPLAT_TRY(const RecordedFrame frame, camera->expose());
      recording.add_frame(frame);
      ++report.frames;
    }
    // What is measured in later steps arrives later than this.
    EDGESPLAT_TRY_STATUS(recording.write_until(host_time_from_ns(kEpoch_ns) + from_seconds(end_s)));
    report.driven_m += driven_between(trajectory, begin_s, end_s);
    report.stopped = !after_step(end_s);
    begin_s = end_s;
  }
  for (const VirtualLidar& lidar : lidars) report.point_packets += lidar.point_packets();
  report.imu_packets = lidars.front().imu_packets();
  return {};
}

}  // namespace

Result<SimulateReport> simulate(const SimulateOptions& options, const SimulateProgress& progress,
                                const std::stop_token& stop) {
  EDGESPLAT_TRY_STATUS(validate(options));
  EDGESPLAT_TRY(const auto world, World::create(options.world));
  EDGESPLAT_TRY_STATUS(write_clean_views(*world, options));
  SimulateReport report;
  if (options.out.empty()) return report;

  TrajectoryConfig drive;
  drive.duration_s = options.seconds;
  drive.body_motion = options.body_motion;
  drive.spin_radps = options.spin_radps;
  drive.seed = options.world.seed;
  EDGESPLAT_TRY(const Trajectory trajectory, Trajectory::create(world->path(), drive));
  EDGESPLAT_TRY(RecordingWriter recording,
                RecordingWriter::create(options.out, 1 + options.more_lidars.size()));
  EDGESPLAT_TRY_STATUS(recording.attach(io::kRigAttachment, sensor::print_rig(simulated_rig(options))));
  EDGESPLAT_TRY_STATUS(recording.attach(io::kWorldAttachment, world_toml(options)));
  const auto after_step = [&](double simulated_s) {
    if (progress) progress(simulated_s);
    return !stop.stop_requested();
  };
  EDGESPLAT_TRY_STATUS(run_steps(*world, trajectory, options, recording, after_step, report));
  EDGESPLAT_TRY_STATUS(recording.close({{"world", options.world.name},
                                        {"pedestrians", std::to_string(options.world.pedestrians)},
                                        {"cars", std::to_string(options.world.cars)},
                                        {"seed", std::to_string(options.world.seed)},
                                        {"lidar", options.lidar == LidarKind::kMid360 ? "mid360" : "avia"},
                                        {"clock", options.clock == ClockMode::kPtp ? "ptp" : "free"}}));
  report.bytes = recording.file().bytes_written();
  return report;
}

}  // namespace edgesplat::simulate
