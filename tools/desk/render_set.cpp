// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/render_set.hpp"

#include "common/io/image_file.hpp"
#include "common/sensor/image_values.hpp"
#include "kernels/image/undistort.hpp"
#include "kernels/splat/render.hpp"

namespace edgesplat::desk {

Result<RenderedView> render_view(const gaussian::GaussianCloud& map, const io::PosedCamera& camera,
                                 const RenderSettings& settings, const Clock& clock) {
  const auto model = image::undistorted_model(camera.camera.scaled(settings.scale));
  EDGESPLAT_TRY(const splat::View view, splat::View::from(model, camera.map_from_camera.inverse()));
  const auto pixels = static_cast<std::size_t>(model.width_px) * static_cast<std::size_t>(model.height_px);
  std::vector<float> colour(3 * pixels), depth(pixels), alpha(pixels);
  splat::RenderOptions options;
  options.background = settings.background;
  options.antialiased = settings.antialiased;
  options.least_axis_px = settings.least_axis_px;
  const HostTime begin = clock.now();
  EDGESPLAT_TRY(const auto stats, splat::render(core::Backend::kCpu, splat::spans_of(map), view, options,
                                                {colour, depth, alpha}));
  const double render_ms = to_seconds(clock.now() - begin) * 1e3;
  return RenderedView{sensor::to_rgb8(colour, model.width_px, model.height_px), render_ms, stats.visible};
}

Result<std::vector<RenderedFile>> render_set(const gaussian::GaussianCloud& map, const io::CameraSet& cameras,
                                             const std::filesystem::path& folder,
                                             const RenderSettings& settings, const Clock& clock) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(Errc::kIo, "cannot make the folder " + folder.string() + ": " + error.message());
  std::vector<RenderedFile> files;
  for (const io::PosedCamera& camera : cameras.cameras) {
    EDGESPLAT_TRY(const RenderedView view, render_view(map, camera, settings, clock));
    const auto file = folder / (camera.name + ".png");
    EDGESPLAT_TRY_STATUS(io::save_image(file, view.picture));
    files.push_back(
        {camera.name, file, view.picture.width_px, view.picture.height_px, view.render_ms, view.visible});
  }
  return files;
}

}  // namespace edgesplat::desk
