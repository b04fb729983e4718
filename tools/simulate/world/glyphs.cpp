// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/glyphs.hpp"

#include "tools/simulate/world/texture_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::simulate {
namespace {

/// Five columns a letter, lowest bit on top.
using Columns = std::array<std::uint8_t, 5>;
constexpr std::array<Columns, 26> kLetters{{
    {0x7E, 0x11, 0x11, 0x11, 0x7E}, {0x7F, 0x49, 0x49, 0x49, 0x36}, {0x3E, 0x41, 0x41, 0x41, 0x22},
    {0x7F, 0x41, 0x41, 0x22, 0x1C}, {0x7F, 0x49, 0x49, 0x49, 0x41}, {0x7F, 0x09, 0x09, 0x09, 0x01},
    {0x3E, 0x41, 0x49, 0x49, 0x7A}, {0x7F, 0x08, 0x08, 0x08, 0x7F}, {0x00, 0x41, 0x7F, 0x41, 0x00},
    {0x20, 0x40, 0x41, 0x3F, 0x01}, {0x7F, 0x08, 0x14, 0x22, 0x41}, {0x7F, 0x40, 0x40, 0x40, 0x40},
    {0x7F, 0x02, 0x0C, 0x02, 0x7F}, {0x7F, 0x04, 0x08, 0x10, 0x7F}, {0x3E, 0x41, 0x41, 0x41, 0x3E},
    {0x7F, 0x09, 0x09, 0x09, 0x06}, {0x3E, 0x41, 0x51, 0x21, 0x5E}, {0x7F, 0x09, 0x19, 0x29, 0x46},
    {0x46, 0x49, 0x49, 0x49, 0x31}, {0x01, 0x01, 0x7F, 0x01, 0x01}, {0x3F, 0x40, 0x40, 0x40, 0x3F},
    {0x1F, 0x20, 0x40, 0x20, 0x1F}, {0x3F, 0x40, 0x38, 0x40, 0x3F}, {0x63, 0x14, 0x08, 0x14, 0x63},
    {0x07, 0x08, 0x70, 0x08, 0x07}, {0x61, 0x51, 0x49, 0x45, 0x43},
}};
constexpr std::array<Columns, 10> kDigits{{
    {0x3E, 0x51, 0x49, 0x45, 0x3E},
    {0x00, 0x42, 0x7F, 0x40, 0x00},
    {0x42, 0x61, 0x51, 0x49, 0x46},
    {0x21, 0x41, 0x45, 0x4B, 0x31},
    {0x18, 0x14, 0x12, 0x7F, 0x10},
    {0x27, 0x45, 0x45, 0x45, 0x39},
    {0x3C, 0x4A, 0x49, 0x49, 0x30},
    {0x01, 0x71, 0x09, 0x05, 0x03},
    {0x36, 0x49, 0x49, 0x49, 0x36},
    {0x06, 0x49, 0x49, 0x29, 0x1E},
}};
constexpr std::array<std::string_view, 16> kWords{"CAMPUS", "MUSIC", "JAZZ",  "OPEN",   "SCIENCE", "ROBOT",
                                                  "CITY",   "MAPS",  "LIGHT", "CINEMA", "SPORT",   "TALKS",
                                                  "HELLO",  "BOOKS", "DANCE", "WORLD"};
/// Mean ink of a text line: letters too small to resolve are grey.
constexpr float kMeanInk = 0.36F;
constexpr double kGreyFrom_cells = 5.0;

bool inked(std::string_view text, int column, int row) {
  if (column < 0 || row < 0 || row > 6) return false;
  const auto letter = static_cast<std::size_t>(column / 6);
  const auto within = static_cast<std::size_t>(column % 6);
  if (letter >= text.size() || within > 4) return false;
  const char c = text[letter];
  const auto bit = static_cast<unsigned>(6 - row);
  const auto has_ink = [&](const Columns& columns) { return (unsigned{columns[within]} >> bit & 1U) != 0U; };
  if (c >= 'A' && c <= 'Z') return has_ink(kLetters[static_cast<std::size_t>(c - 'A')]);
  if (c >= '0' && c <= '9') return has_ink(kDigits[static_cast<std::size_t>(c - '0')]);
  return false;
}

}  // namespace

float text_coverage(std::string_view text, double x, double y, double footprint) {
  const double width = kGlyphPitch_cells * static_cast<double>(text.size());
  const double half = std::max(footprint, 0.05) / 2.0;
  if (x + half < 0 || y + half < 0 || x - half > width || y - half > kGlyphHeight_cells) return 0.0F;
  if (footprint > kGreyFrom_cells)
    return kMeanInk * box_coverage(x, 0, width, footprint) *
           box_coverage(y, 0, kGlyphHeight_cells, footprint);
  float ink = 0.0F;
  for (int row = static_cast<int>(std::floor(y - half)); row <= static_cast<int>(std::floor(y + half));
       ++row) {
    for (int column = static_cast<int>(std::floor(x - half));
         column <= static_cast<int>(std::floor(x + half)); ++column) {
      if (!inked(text, column, row)) continue;
      ink += box_coverage(x, column, column + 1, 2 * half) * box_coverage(y, row, row + 1, 2 * half);
    }
  }
  return std::min(ink, 1.0F);
}

std::string_view poster_word(std::uint32_t pick) {
  return kWords[pick % kWords.size()];
}

}  // namespace edgesplat::simulate
