// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/gaussian/gaussian_cloud.hpp"

#include "common/base/check.hpp"

#include <algorithm>

namespace edgesplat::gaussian {
namespace {

void append_values(std::vector<float>& to, const std::vector<float>& from, std::size_t row,
                   std::size_t width) {
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(row * width);
  to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(width));
}

void copy_values(std::vector<float>& values, std::size_t from, std::size_t to, std::size_t width) {
  const auto source = values.begin() + static_cast<std::ptrdiff_t>(from * width);
  std::copy_n(source, width, values.begin() + static_cast<std::ptrdiff_t>(to * width));
}

}  // namespace

bool GaussianCloud::consistent() const {
  const std::size_t n = ids.size();
  return sh_degree >= 0 && sh_degree <= 3 && means_m.size() == 3 * n && log_scales.size() == 3 * n &&
         quats_xyzw.size() == 4 * n && opacity_logits.size() == n && sh.size() == sh_floats_each() * n &&
         anchors.size() == n;
}

void GaussianCloud::resize(std::size_t count) {
  ids.resize(count);
  means_m.resize(3 * count);
  log_scales.resize(3 * count);
  quats_xyzw.resize(4 * count);
  opacity_logits.resize(count);
  sh.resize(sh_floats_each() * count);
  anchors.resize(count);
}

void GaussianCloud::append_row(const GaussianCloud& other, std::size_t row) {
  EDGESPLAT_CHECK(sh_degree == other.sh_degree && row < other.size(), "rows of one SH degree");
  ids.push_back(other.ids[row]);
  append_values(means_m, other.means_m, row, 3);
  append_values(log_scales, other.log_scales, row, 3);
  append_values(quats_xyzw, other.quats_xyzw, row, 4);
  opacity_logits.push_back(other.opacity_logits[row]);
  append_values(sh, other.sh, row, sh_floats_each());
  anchors.push_back(other.anchors[row]);
}

void GaussianCloud::copy_row(std::size_t from, std::size_t to) {
  EDGESPLAT_CHECK(from < size() && to < size(), "row in range");
  ids[to] = ids[from];
  copy_values(means_m, from, to, 3);
  copy_values(log_scales, from, to, 3);
  copy_values(quats_xyzw, from, to, 4);
  opacity_logits[to] = opacity_logits[from];
  copy_values(sh, from, to, sh_floats_each());
  anchors[to] = anchors[from];
}

}  // namespace edgesplat::gaussian
