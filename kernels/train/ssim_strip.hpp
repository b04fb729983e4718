// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace edgesplat::train {

/// SSIM works on pieces of the picture that fit the cache. Rows of floats (3 a pixel) stream through two
/// separable filters, one for the local moments and one for the gradient, kSsimBatch rows at a time. A tap k
/// of the window is 3 k floats away.

inline constexpr int kSsimLanes = 16;  ///< rows are whole registers of at most so many
inline constexpr int kSsimRadius = 5;
inline constexpr int kSsimTaps = 2 * kSsimRadius + 1;
inline constexpr int kSsimBatch = 4;
inline constexpr int kSsimWindow = kSsimTaps + kSsimBatch - 1;  ///< rows that a batch of results needs
inline constexpr int kSsimLead = kSsimBatch * 3;  ///< rows from the first of a batch to what needs it last
inline constexpr int kSsimSkip =
    kSsimLead - 2 * kSsimRadius;      ///< rows of a window's start that no result needs
inline constexpr int kSsimRing = 16;  ///< rows kept, a power of two >= kSsimWindow
static_assert(kSsimRing >= kSsimWindow && kSsimLead + kSsimBatch >= kSsimSkip + kSsimWindow);

constexpr int whole_lanes(int floats) {
  return (floats + kSsimLanes - 1) / kSsimLanes * kSsimLanes;
}
inline constexpr int kSsimStripPx = 128;                                   ///< width of a piece
inline constexpr int kSsimStripRows = 128;                                 ///< height of a piece
inline constexpr int kSsimHalo = 3 * kSsimRadius;                          ///< floats
inline constexpr int kSsimOut = 3 * kSsimStripPx;                          ///< floats a row of the result
inline constexpr int kSsimMiddle = whole_lanes(kSsimOut + 2 * kSsimHalo);  ///< of the similarity
inline constexpr int kSsimIn = kSsimMiddle + 2 * kSsimHalo;                ///< of the pictures

}  // namespace edgesplat::train
