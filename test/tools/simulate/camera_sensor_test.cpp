// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/camera_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::simulate {
namespace {

sensor::ImageRgbF32 even(float value, int side = 64) {
  return {side, side, value};
}

CameraSensorConfig quiet() {
  CameraSensorConfig config;
  config.vignetting = 0.0;
  config.full_well_electrons = 1e12;
  config.read_noise_electrons = 0.0;
  return config;
}

TEST(CameraSensor, EncodesSrgb) {
  const CameraSensor sensor(quiet());
  EXPECT_EQ(sensor.expose_ideal(even(0.0F), 0).values[0], 0);
  EXPECT_EQ(sensor.expose_ideal(even(1.0F), 0).values[0], 255);
  EXPECT_EQ(sensor.expose_ideal(even(0.2140F), 0).values[0], 127);  // IEC 61966-2-1
  EXPECT_EQ(sensor.expose_ideal(even(7.0F), 0).values[0], 255);
  EXPECT_EQ(sensor.expose_ideal(even(-1.0F), 0).values[0], 0);
}

TEST(CameraSensor, WithoutFaultsIsIdeal) {
  const CameraSensor sensor(quiet());
  EXPECT_EQ(sensor.expose(even(0.4F), 3, 0.0).values, sensor.expose_ideal(even(0.4F), 0.0).values);
}

TEST(CameraSensor, LightThatGoesOutIsNotInTheExposureThatIsTold) {
  CameraSensorConfig config = quiet();
  config.light_steps = {{1.0, 0.0}, {2.0, 1.0}};
  const CameraSensor sensor(config);
  EXPECT_EQ(sensor.expose(even(0.4F), 0, 1.5).values[0], 0);
  EXPECT_EQ(sensor.expose(even(0.4F), 0, 2.5).values, sensor.expose(even(0.4F), 0, 0.5).values);
  EXPECT_EQ(sensor.exposure_s(1.5), sensor.exposure_s(0.5));
}

TEST(CameraSensor, NoiseHasTheStatedDeviation) {
  CameraSensorConfig config = quiet();
  config.full_well_electrons = 5000;
  config.read_noise_electrons = 10;
  const sensor::ImageRgb8 image = CameraSensor(config).expose(even(0.5F, 128), 0, 0.0);
  double sum = 0.0, sum2 = 0.0;
  for (const std::uint8_t code : image.values) {
    const double s = code / 255.0, linear = std::pow((s + 0.055) / 1.055, 2.4);
    sum += linear;
    sum2 += linear * linear;
  }
  const double n = static_cast<double>(image.values.size()), mean = sum / n;
  EXPECT_NEAR(mean, 0.5, 0.002);
  const double expected = std::sqrt(2500.0 + 100.0) / 5000.0;
  EXPECT_NEAR(std::sqrt(sum2 / n - mean * mean), expected, 0.1 * expected);
}

TEST(CameraSensor, NoiseIsReproducibleAndNewInEachFrame) {
  const CameraSensor sensor(CameraSensorConfig{});
  EXPECT_EQ(sensor.expose(even(0.3F), 5, 0).values, sensor.expose(even(0.3F), 5, 0).values);
  EXPECT_NE(sensor.expose(even(0.3F), 5, 0).values, sensor.expose(even(0.3F), 6, 0).values);
}

TEST(CameraSensor, CornersAreDarkerByTheVignetting) {
  CameraSensorConfig config = quiet();
  config.vignetting = 0.5;
  const sensor::ImageRgb8 image = CameraSensor(config).expose(even(0.8F, 65), 0, 0);
  const CameraSensor plain(quiet());
  EXPECT_EQ(*image.pixel(32, 32), plain.expose_ideal(even(0.8F), 0).values[0]);
  EXPECT_NEAR(*image.pixel(0, 0), plain.expose_ideal(even(0.4F), 0).values[0], 1);
}

TEST(CameraSensor, ExposureStepsChangeTheBrightness) {
  CameraSensorConfig config = quiet();
  config.exposure_steps = {{1.0, 0.5}, {2.0, 2.0}};
  const CameraSensor sensor(config);
  EXPECT_DOUBLE_EQ(sensor.exposure_s(0.5), config.exposure_s);
  EXPECT_DOUBLE_EQ(sensor.exposure_s(1.0), 0.5 * config.exposure_s);
  EXPECT_DOUBLE_EQ(sensor.exposure_s(9.0), 2.0 * config.exposure_s);
  EXPECT_EQ(sensor.expose_ideal(even(0.4F), 2.5).values, sensor.expose_ideal(even(0.8F), 0.0).values);
}

}  // namespace
}  // namespace edgesplat::simulate
