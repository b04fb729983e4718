// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace edgesplat::simulate {

/// Letters are 5 by 7 cells, one cell apart.
inline constexpr double kGlyphPitch_cells = 6.0;
inline constexpr double kGlyphHeight_cells = 7.0;

/// Share of ink in the footprint around (x, y), in cells from the lower left corner of the text. A-Z, 0-9;
/// everything else is blank.
[[nodiscard]] float text_coverage(std::string_view text, double x_cells, double y_cells,
                                  double footprint_cells);

/// A word that a poster may carry; any number picks one.
[[nodiscard]] std::string_view poster_word(std::uint32_t pick);

}  // namespace edgesplat::simulate
