// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/io/camera_set.hpp"
#include "common/sensor/image.hpp"
#include "common/time/clock.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::desk {

/// What a map shows in a camera; the camera's distortion is left out.
struct RenderedView {
  sensor::ImageRgb8 picture;
  double render_ms = 0.0;
  std::size_t visible = 0;  ///< Gaussians that the picture shows
};
struct RenderSettings {
  double scale = 1.0;                 ///< of the cameras' sizes
  std::array<float, 3> background{};  ///< 0..1
  bool antialiased = false;           ///< splat::RenderOptions
  float least_axis_px = 0.0F;         ///< splat::RenderOptions
};
[[nodiscard]] Result<RenderedView> render_view(const gaussian::GaussianCloud& map,
                                               const io::PosedCamera& camera, const RenderSettings& settings,
                                               const Clock& clock);

struct RenderedFile {
  std::string name;
  std::filesystem::path file;
  int width_px = 0;
  int height_px = 0;
  double render_ms = 0.0;
  std::size_t visible = 0;
};

/// Draws every camera of a set into `folder`/<name>.png.
[[nodiscard]] Result<std::vector<RenderedFile>> render_set(const gaussian::GaussianCloud& map,
                                                           const io::CameraSet& cameras,
                                                           const std::filesystem::path& folder,
                                                           const RenderSettings& settings,
                                                           const Clock& clock);

}  // namespace edgesplat::desk
