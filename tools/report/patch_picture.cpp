// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/patch_picture.hpp"

#include "tools/report/html_text.hpp"
#include "tools/report/picture_embed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::report {
namespace {

/// Whatever the picture's size, the figure is this many units wide, so that lines and letters look alike.
constexpr double kWidth = 640.0;
constexpr double kLegend = 40.0;
constexpr int kEmbedded_px = 640;
/// The end of the scale: tracking lets patches of larger misfits count little or not at all.
constexpr double kMostMisfit = 3.0;
/// More are drawn by none of our programs; a file that claims more is cut.
constexpr std::size_t kMostPatches = 5000;

struct Colour {
  int red, green, blue;
};
/// From a good fit to a bad one: told apart by brightness too, for those who see few colours.
constexpr std::array<Colour, 4> kScale{{{64, 224, 208}, {120, 230, 110}, {250, 215, 60}, {255, 140, 40}}};
constexpr const char* kRejected = "#ff3b6b";

std::string colour_of(double misfit) {
  const double at = std::clamp(misfit / kMostMisfit, 0.0, 1.0) * static_cast<double>(kScale.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
  const double share = at - static_cast<double>(lower);
  const auto mix = [share](int a, int b) { return static_cast<int>(std::lround(a + share * (b - a))); };
  const Colour &a = kScale[lower], &b = kScale[lower + 1];
  return fmt::format("#{:02x}{:02x}{:02x}", mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue));
}

struct Patch {
  double x, y, half;  ///< in units of the figure
  double misfit;
  bool used;
};

/// A square, or one crossed out, over a dark rim that keeps it legible on any ground.
std::string draw(const Patch& patch) {
  const double x = patch.x - patch.half, y = patch.y - patch.half, side = 2.0 * patch.half;
  std::string path = fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}z", x, y, side, side, -side);
  if (!patch.used)
    path += fmt::format("l{:.1f} {:.1f}m0 {:.1f}l{:.1f} {:.1f}", side, side, -side, -side, side);
  return fmt::format(
      "<g><title>misfit {:.1f}{}</title><path d=\"{}\" fill=\"none\" stroke=\"#000\" stroke-opacity=\".55\" "
      "stroke-width=\"3.6\"/><path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.7\"/></g>\n",
      patch.misfit, patch.used ? "" : ", not used", path, path,
      patch.used ? colour_of(patch.misfit) : kRejected);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"13\">{}</text>\n", x, y,
                     anchor, escape_html(text));
}

std::string legend(double top) {
  constexpr int kSteps = 36;
  constexpr double kBarLeft = 30.0, kBarWidth = 216.0, kBarHeight = 10.0;
  std::string svg;
  for (int i = 0; i < kSteps; ++i)
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.0f}\" fill=\"{}\"/>\n",
                       kBarLeft + i * kBarWidth / kSteps, top + 8.0, kBarWidth / kSteps + 0.3, kBarHeight,
                       colour_of(kMostMisfit * (i + 0.5) / kSteps));
  for (int tick = 0; tick <= static_cast<int>(kMostMisfit); ++tick)
    svg += text_at(kBarLeft + tick * kBarWidth / kMostMisfit, top + 32.0, "middle", std::to_string(tick));
  svg += text_at(kBarLeft + kBarWidth + 14.0, top + 18.0, "start", "times the usual residual");
  svg += draw({kBarLeft + 410.0, top + 14.0, 8.0, 2.0 * kMostMisfit, false});
  return svg + text_at(kBarLeft + 426.0, top + 18.0, "start", "not used");
}

}  // namespace

Result<std::string> patch_picture(const sensor::ImageRgb8& picture, const CsvTable& table,
                                  const std::string& name) {
  for (const char* column : {"x_px", "y_px", "side_px", "misfit", "used"}) {
    if (!table.has(column)) return fail(Errc::kCorrupt, name + ": its patches have no column " + column);
  }
  EDGESPLAT_TRY(const std::string uri, embed(picture, kEmbedded_px));
  const double scale = kWidth / picture.width_px;
  const double height = scale * picture.height_px;
  const auto xs = table.numbers("x_px"), ys = table.numbers("y_px"), sides = table.numbers("side_px");
  const auto misfits = table.numbers("misfit"), uses = table.numbers("used");
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < std::min(table.rows(), kMostPatches); ++i) {
    const Patch patch{(xs[i] + 0.5) * scale, (ys[i] + 0.5) * scale,
                      std::clamp(0.5 * sides[i] * scale, 3.0, 40.0), misfits[i], uses[i] == 1.0};
    const bool inside = patch.x >= 0.0 && patch.x <= kWidth && patch.y >= 0.0 && patch.y <= height;
    if (inside && std::isfinite(patch.half) && std::isfinite(patch.misfit)) patches.push_back(patch);
  }
  // Those left out lie on top: they are what one looks for.
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.used > b.used; });
  const auto used = std::ranges::count_if(patches, [](const Patch& patch) { return patch.used; });
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.1f}\" role=\"img\" aria-label=\"{}\">\n<image href=\"{}\" "
      "width=\"{:.0f}\" "
      "height=\"{:.1f}\" preserveAspectRatio=\"none\"/>\n",
      kWidth, height + kLegend, escape_html(name), uri, kWidth, height);
  for (const Patch& patch : patches) svg += draw(patch);
  svg += legend(height) + "</svg>\n";
  return "<figure>" + svg + "<figcaption>" +
         escape_html(fmt::format("{}: {} of {} patches used", name, used, patches.size())) +
         "</figcaption></figure>\n";
}

}  // namespace edgesplat::report
