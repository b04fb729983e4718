// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgesplat::image {

/// Rows of the pictures that GrayPyramid halves, in vectors; every set of instructions gives the same bits.
/// Rows may begin at any address.

/// Brightness of the mean of 2 x 2 pixels: two rows of 2 * `count` RGB pixels become `count` values.
void half_gray_row(const std::uint8_t* rgb_above, const std::uint8_t* rgb_below, std::uint8_t* gray,
                   std::size_t count);
/// The mean of 2 x 2: two rows of 2 * `count` values become `count`.
void half_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* half, std::size_t count);
/// Brightness of `count` RGB pixels.
void gray_row(const std::uint8_t* rgb, std::uint8_t* gray, std::size_t count);

}  // namespace edgesplat::image
