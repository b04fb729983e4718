// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"
#include "tools/report/csv_table.hpp"

#include <string>

namespace edgesplat::report {

/// A camera's picture with the patches on it that tracking held it against (columns x_px, y_px, side_px,
/// misfit, used): coloured by how well each fits, crossed out where it did not count; with a legend. As HTML:
/// a figure that stays sharp at any size, a patch's misfit shown under the pointer. kCorrupt where the table
/// lacks a column.
[[nodiscard]] Result<std::string> patch_picture(const sensor::ImageRgb8& picture, const CsvTable& patches,
                                                const std::string& name);

}  // namespace edgesplat::report
