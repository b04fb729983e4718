// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/render_loop.hpp"

#include "robot/app/picture_log.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <sstream>
#include <vector>

namespace edgesplat::app {
namespace {

sensor::CameraMount small_camera() {
  sensor::CameraMount mount;
  mount.model = {geometry::CameraKind::kPinhole, 32, 24, 30.0, 30.0, 15.5, 11.5, {}};
  return mount;
}

/// Keeps what it is told and wakes who waits for it.
class Pictures {
 public:
  void add(const PictureTimes& picture) {
    const std::lock_guard lock(mutex_);
    times_.push_back(picture);
    more_.notify_all();
  }
  std::vector<PictureTimes> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(more_.wait_for(lock, std::chrono::seconds(30), [&] { return times_.size() >= count; }));
    return times_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable more_;
  std::vector<PictureTimes> times_;
};

TEST(RenderLoop, DrawsAtItsOwnRateFromTheNewestPoseWhetherOrNotANewOneCame) {
  const SteadyClock clock;
  metrics::Registry metrics;
  Pictures pictures;
  std::shared_ptr<const gaussian::GaussianCloud> cloud =
      std::make_shared<const gaussian::GaussianCloud>(test::random_gaussians(50, 1));
  RenderLoop loop(
      {10.0}, small_camera(), [&] { return cloud; }, clock, metrics,
      [&](const PictureTimes& picture) { pictures.add(picture); });
  loop.show_from({});
  const auto times = pictures.wait_for(6);
  ASSERT_GE(times.size(), 6U);
  EXPECT_GE(times[5].began - times[0].began, from_seconds(0.4)) << "and no faster";
  EXPECT_GE(metrics.counter("render.frames").value(), 6U);
  EXPECT_GE(metrics.histogram("render.interval_ms").summary().count, 5U);
}

TEST(RenderLoop, NeverDrawsWhereTheRateIsNoneAndEndsAtOnce) {
  const SteadyClock clock;
  metrics::Registry metrics;
  std::shared_ptr<const gaussian::GaussianCloud> cloud =
      std::make_shared<const gaussian::GaussianCloud>(test::random_gaussians(50, 1));
  {
    RenderLoop loop(
        {0.0}, small_camera(), [&] { return cloud; }, clock, metrics);
    for (int i = 0; i < 5; ++i) loop.show_from({});
  }
  {
    RenderLoop without_a_pose(
        {30.0}, small_camera(), [&] { return cloud; }, clock, metrics);
  }
  EXPECT_EQ(metrics.counter("render.frames").value(), 0U);
}

TEST(PictureLog, HasALineForEachPicture) {
  const test::TempDir folder;
  {
    PictureLog log(folder / "frames.csv");
    log.add({HostTime(std::chrono::microseconds(12'000'034)), 1.25});
    PictureLog nowhere("/proc/nowhere/frames.csv");
    nowhere.add({});
  }
  std::ostringstream text;
  text << std::ifstream(folder / "frames.csv").rdbuf();
  EXPECT_EQ(text.str(), "began_s,took_ms\n12.000034,1.250\n");
}

}  // namespace
}  // namespace edgesplat::app
