// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/pattern.hpp"

#include "tools/simulate/world/glyphs.hpp"
#include "tools/simulate/world/texture_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector2d;

Rgb mix(const Rgb& a, const Rgb& b, float share_of_b) {
  return a + share_of_b * (b - a);
}

/// Printing inks, linear.
const std::array<Rgb, 8>& inks() {
  static const std::array<Rgb, 8> kInks{
      Rgb{0.62F, 0.06F, 0.05F}, Rgb{0.03F, 0.12F, 0.42F}, Rgb{0.85F, 0.55F, 0.03F}, Rgb{0.02F, 0.28F, 0.16F},
      Rgb{0.45F, 0.10F, 0.40F}, Rgb{0.02F, 0.35F, 0.45F}, Rgb{0.80F, 0.25F, 0.05F}, Rgb{0.05F, 0.05F, 0.06F}};
  return kInks;
}

/// Coordinates on a sheet of width 1, and the footprint there.
struct Sheet {
  Vector2d at;
  double footprint;
  std::uint32_t seed;
  [[nodiscard]] std::uint32_t pick(std::int32_t what) const { return cell_hash(what, 17, seed); }
  [[nodiscard]] double pick(std::int32_t what, double lo, double hi) const {
    return lo + (hi - lo) * static_cast<double>(cell_value(what, 23, seed));
  }
};

/// A picture of discs and slanted bars.
Rgb abstract_art(const Sheet& s, Rgb colour) {
  for (int i = 0; i < 7; ++i) {
    const Rgb& ink = inks()[s.pick(40 + i) % inks().size()];
    const Vector2d centre(s.pick(50 + i, 0.1, 0.9), s.pick(60 + i, 0.5, 1.3));
    const double size = s.pick(70 + i, 0.06, 0.24);
    float share = disc_coverage(s.at - centre, size, s.footprint);
    if (s.pick(80 + i) % 3 == 0) {
      const double slope = s.pick(90 + i, -0.6, 0.6);
      const double across = s.at.y() - centre.y() - slope * (s.at.x() - centre.x());
      share = box_coverage(across, -size / 4, size / 4, s.footprint);
    } else if (s.pick(80 + i) % 3 == 1) {
      share -= disc_coverage(s.at - centre, size * 0.65, s.footprint);
    }
    colour = mix(colour, ink, share);
  }
  return colour;
}

/// A photograph of hills under a sky.
Rgb landscape_art(const Sheet& s, Rgb colour) {
  const float inside =
      box_coverage(s.at.x(), 0.06, 0.94, s.footprint) * box_coverage(s.at.y(), 0.42, 1.1, s.footprint);
  if (inside <= 0.0F) return colour;
  const auto sky = static_cast<float>((s.at.y() - 0.42) / 0.7);
  Rgb photo = mix(Rgb{0.75F, 0.55F, 0.40F}, Rgb{0.15F, 0.35F, 0.70F}, sky);
  for (int ridge = 0; ridge < 4; ++ridge) {
    const double top = 0.95 - 0.13 * ridge +
                       0.10 * octave_noise({s.at.x() * 2.0 + 9.0 * ridge, 3.0 * ridge},
                                           {1.0, 0.02, 0.5F, s.seed}, s.footprint);
    const float grain = octave_noise(s.at, {0.1, 0.004, 0.8F, s.seed + 11}, s.footprint);
    const Rgb hill =
        inks()[s.pick(30 + ridge) % 6] * (0.5F + 0.25F * static_cast<float>(ridge)) * (1.0F + 0.5F * grain);
    photo = mix(photo, hill, box_coverage(s.at.y(), 0.0, top, s.footprint));
  }
  return mix(colour, photo, inside);
}

float text_line(const Sheet& s, std::string_view text, const Vector2d& corner, double height) {
  const double cell = height / kGlyphHeight_cells;
  return text_coverage(text, (s.at.x() - corner.x()) / cell, (s.at.y() - corner.y()) / cell,
                       s.footprint / cell);
}

/// A paragraph of small letters below the picture; only the line that the point is on is looked at.
float small_print(const Sheet& s) {
  constexpr double kPitch = 0.048, kHeight = 0.028, kBottom = 0.06;
  const int line = static_cast<int>(std::floor((s.at.y() - kBottom) / kPitch));
  if (line < 0 || line > 5) return 0.0F;
  if (s.footprint > kHeight)  // too small to read: even grey
    return 0.2F * box_coverage(s.at.x(), 0.08, 0.85, s.footprint);
  std::string text(14 + s.pick(100 + line) % 16U, 'A');
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint32_t letter = cell_hash(static_cast<int>(i), line, s.seed);
    text[i] = letter % 6 == 0 ? ' ' : static_cast<char>('A' + letter % 26);
  }
  return text_line(s, text, {0.08, kBottom + kPitch * line}, kHeight);
}

}  // namespace

Rgb poster_albedo(const Material& m, const TexturePoint& at) {
  const double width_m = m.period_m;
  const Sheet s{at.uv_m / width_m, at.footprint_m / width_m, m.seed};
  const Rgb ink = inks()[s.pick(1) % inks().size()];
  const bool dark = s.pick(2) % 3 == 0;
  Rgb colour = dark ? Rgb(inks()[s.pick(3) % inks().size()]) : m.base;
  colour =
      mix(colour, m.accent, dark ? 0.0F : 0.35F * static_cast<float>(std::clamp(s.at.y() / 1.4, 0.0, 1.0)));
  colour = s.pick(4) % 2 == 0 ? landscape_art(s, colour) : abstract_art(s, colour);
  const Rgb print = dark ? Rgb(0.85F, 0.84F, 0.80F) : ink;
  const std::string_view word = poster_word(s.pick(5));
  const double height = std::min(0.16, 0.84 * 7.0 / (6.0 * static_cast<double>(word.size())));
  colour = mix(colour, print, text_line(s, word, {0.08, 1.16}, height));
  colour = mix(colour, print, small_print(s));
  const float paper = octave_noise(at.uv_m, {0.04, 0.003, 0.8F, m.seed}, at.footprint_m);
  return colour * (1.0F + 0.04F * paper);
}

Rgb sign_albedo(const Material& m, const TexturePoint& at) {
  const double width_m = m.period_m;
  const Sheet s{at.uv_m / width_m, at.footprint_m / width_m, m.seed};
  std::string number{static_cast<char>('A' + s.pick(6) % 6), static_cast<char>('1' + s.pick(7) % 4),
                     static_cast<char>('0' + s.pick(8) % 10), static_cast<char>('0' + s.pick(9) % 10)};
  const double height = 0.7 * kGlyphHeight_cells / (kGlyphPitch_cells * static_cast<double>(number.size()));
  return mix(m.base, m.accent, text_line(s, number, {0.16, 0.04}, height));
}

}  // namespace edgesplat::simulate
