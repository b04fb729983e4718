// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/picture_embed.hpp"
#include "tools/report/sections.hpp"

#include <fmt/format.h>

namespace edgesplat::report {
namespace {

constexpr int kPictureWidth_px = 640;

/// Empty where there is no such file; a damaged one is said in `missing`.
std::optional<sensor::ImageRgb8> load(const std::filesystem::path& path, std::vector<std::string>& missing) {
  if (path.empty()) return std::nullopt;
  auto picture = io::load_rgb8(path);
  if (picture) return *std::move(picture);
  missing.push_back(picture.error().context);
  return std::nullopt;
}

std::string figure(const std::optional<sensor::ImageRgb8>& picture, const std::string& caption) {
  if (!picture) return html_paragraph(caption + ": not there");
  const auto uri = embed(*picture, kPictureWidth_px);
  return uri ? html_picture(*uri, caption) : html_paragraph(uri.error().context);
}

KeyframePictures show(const KeyframeFiles& files, std::vector<std::string>& missing) {
  const auto image = load(files.image, missing);
  const auto overlay = load(files.overlay, missing);
  const auto render = load(files.render, missing);
  KeyframePictures shown;
  if (image && render) shown.quality = compare_render(*image, *render);
  const std::string quality = shown.quality
                                  ? fmt::format(", PSNR {:.1f} dB over the {:.0f} % that are mapped",
                                                shown.quality->psnr_db, 100.0 * shown.quality->coverage)
                                  : "";
  shown.html = html_picture_grid({figure(image, "keyframe " + files.number + ": camera"),
                                  figure(render, "Gaussians from the same pose" + quality),
                                  figure(overlay, "LiDAR points projected, coloured by distance")});
  return shown;
}

}  // namespace

std::vector<KeyframePictures> keyframe_pictures(RunFolder& run, std::size_t limit) {
  std::vector<KeyframePictures> pictures;
  const std::size_t count = std::min(limit, run.keyframes.size());
  for (std::size_t i = 0; i < count; ++i) {
    // Evenly spread, the last one included: by then the map has seen most.
    const std::size_t index = (i + 1) * run.keyframes.size() / count - 1;
    pictures.push_back(show(run.keyframes[index], run.missing));
  }
  return pictures;
}

std::string camera_section(const std::vector<KeyframePictures>& pictures) {
  if (pictures.empty())
    return html_section("Camera and Gaussians", html_paragraph("The run has no camera pictures."));
  std::string body;
  for (const KeyframePictures& picture : pictures) body += picture.html;
  return html_section("Camera and Gaussians", body);
}

}  // namespace edgesplat::report
