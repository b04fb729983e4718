// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/aravis/gige_camera.hpp"
#include "test/support/own_loopback_address.hpp"
#include "tools/virtual_device/gige_server.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

namespace edgesplat::virtual_device {

inline constexpr std::int64_t kGigeEpoch_ns = 1'700'000'000'000'000'000;

/// A picture whose every pixel tells the frame it belongs to and its place.
inline std::shared_ptr<const sensor::ImageRgb8> numbered_picture(int width_px, int height_px,
                                                                 std::uint32_t k) {
  auto image = std::make_shared<sensor::ImageRgb8>(width_px, height_px);
  for (std::size_t i = 0; i < image->values.size(); ++i)
    image->values[i] = static_cast<std::uint8_t>((i * 2654435761U + k * 97U) >> 13U);
  return image;
}

/// Under a sanitizer neither end follows at the full rate.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double kSlowDown = 5.0;
#else
inline constexpr double kSlowDown = 1.0;
#endif

inline constexpr bool kMustKeepUp = kSlowDown == 1.0;

/// A virtual camera that exposes at a steady rate on a thread of its own, as a trigger line makes it.
class PulsedCamera {
 public:
  PulsedCamera(const GigeServerOptions& options, double rate_hz)
      : period_(from_seconds(kSlowDown / rate_hz)) {
    auto opened = GigeServer::open(options, clock_);
    EXPECT_TRUE(opened.has_value()) << (opened ? "" : opened.error().context);
    server_ = *std::move(opened);
    server_->set_ptp(true);
    server_->set_clock([this](HostTime now) { return sensor_time_from_ns(epoch_ns_) + (now - begin_); });
    width_px_ = static_cast<int>(options.model.width_px);
    height_px_ = static_cast<int>(options.model.height_px);
  }
  ~PulsedCamera() { stop_pulses(); }
  PulsedCamera(const PulsedCamera&) = delete;
  PulsedCamera& operator=(const PulsedCamera&) = delete;

  void start_pulses() {
    pulses_ = std::jthread([this](const std::stop_token& stop) {
      for (auto k = 1 + (clock_.now() - begin_) / period_; !stop.stop_requested(); ++k) {
        std::this_thread::sleep_for(begin_ + k * period_ - clock_.now());
        server_->push(exposure(static_cast<std::uint32_t>(k)));
      }
    });
  }
  void stop_pulses() {
    pulses_.request_stop();
    if (pulses_.joinable()) pulses_.join();
  }
  [[nodiscard]] GigeExposure exposure(std::uint32_t k) const {
    GigeExposure exposure;
    exposure.image = numbered_picture(width_px_, height_px_, k);
    exposure.start = sensor_time_from_ns(epoch_ns_ + std::int64_t{k} * period_.count());
    exposure.exposure_us = 8000.0F + static_cast<float>(k % 50);
    exposure.gain_db = 1.5F;
    return exposure;
  }
  /// Which pulse a frame's stamp, the middle of its exposure, belongs to.
  [[nodiscard]] std::uint32_t pulse_of(SensorTime middle) const {
    return static_cast<std::uint32_t>((to_ns(middle) - epoch_ns_) / period_.count());
  }
  [[nodiscard]] GigeServer& server() { return *server_; }
  /// The camera's clock shows this at that moment. Call while no pulses run.
  void set_epoch(std::int64_t epoch_ns, HostTime begin) {
    epoch_ns_ = epoch_ns;
    begin_ = begin;
  }
  /// When the camera's clock showed this.
  [[nodiscard]] HostTime host_time_of(SensorTime stamp) const {
    return begin_ + (stamp - sensor_time_from_ns(epoch_ns_));
  }

 private:
  SteadyClock clock_;
  HostTime begin_ = clock_.now();
  std::int64_t epoch_ns_ = kGigeEpoch_ns;
  nanoseconds period_;
  std::unique_ptr<GigeServer> server_;
  int width_px_ = 0, height_px_ = 0;
  std::jthread pulses_;
};

inline aravis::GigeCameraConfig robot_config_for(const GigeServerOptions& options) {
  aravis::GigeCameraConfig config;
  config.address = options.address;
  config.pixel_format = aravis::PixelFormat::kRgb8;
  config.ptp_settle_s = 0.2;
  config.silence_s = 5.0;  // a busy machine is no fault
  config.ptp_wait_s = 5.0;
  return config;
}

}  // namespace edgesplat::virtual_device
