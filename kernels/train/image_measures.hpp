// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/train/colour_pair.hpp"
#include "kernels/train/ssim.hpp"

namespace edgesplat::train {

/// Peak signal-to-noise ratio in dB, peak 1, over the pixels that count, drawn values cut to 0..1 as a screen
/// does. 100 for equal pictures; 0 where no pixel counts. The measure beside it is ssim() of ssim.hpp (give
/// it pictures cut to 0..1).
[[nodiscard]] double psnr_db(const ColourPair& pair);

}  // namespace edgesplat::train
