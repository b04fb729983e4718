// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ply_compressed.hpp"

#include "common/io/gaussian_values.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace edgesplat::io::ply {
namespace {

using gaussian::GaussianCloud;

constexpr std::size_t kRowsAChunk = 256;
constexpr std::array<std::string_view, 4> kPackedColumns = {"packed_position", "packed_rotation",
                                                            "packed_scale", "packed_color"};
constexpr std::array<std::string_view, 18> kChunkColumns = {
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::size_t kChunkFloats = kChunkColumns.size();

/// The lowest `bits` bits of a word as 0..1.
float unit(std::uint32_t word, unsigned bits) {
  const std::uint32_t mask = (1U << bits) - 1U;
  return static_cast<float>(word & mask) / static_cast<float>(mask);
}

using Triple = std::array<float, 3>;
Triple unpack_11_10_11(std::uint32_t word) {
  return {unit(word >> 21U, 11), unit(word >> 11U, 10), unit(word, 11)};
}

Triple mix(std::span<const float> low_high, const Triple& share) {
  Triple out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = low_high[i] * (1.0F - share[i]) + low_high[3 + i] * share[i];
  }
  return out;
}

/// Two bits say which of w, x, y, z is the largest; the other three follow with ten bits each.
std::array<float, 4> unpack_rotation_xyzw(std::uint32_t word) {
  std::array<float, 3> small{};
  float rest = 1.0F;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto shift = static_cast<unsigned>(20 - 10 * i);
    small[i] = (unit(word >> shift, 10) - 0.5F) * std::numbers::sqrt2_v<float>;
    rest -= small[i] * small[i];
  }
  std::array<float, 4> wxyz{};
  const std::size_t largest = word >> 30U;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i)
    wxyz[i] = i == largest ? std::sqrt(std::max(0.0F, rest)) : small[next++];
  return {wxyz[1], wxyz[2], wxyz[3], wxyz[0]};
}

Result<std::vector<std::size_t>> find_columns(const Table& table, std::span<const std::string_view> names) {
  std::vector<std::size_t> columns;
  for (const auto name : names) {
    const auto column = table.find(name);
    if (!column) {
      return fail(Errc::kCorrupt,
                  "the compressed PLY file has no " + table.name + " column " + std::string(name));
    }
    columns.push_back(*column);
  }
  return columns;
}

/// kChunkFloats a chunk; older files have no colour range: 0..1 then.
Result<std::vector<float>> read_chunks(const Table& table) {
  const bool has_colours = table.find("min_r").has_value();
  const std::size_t width = has_colours ? kChunkFloats : 12;
  EDGESPLAT_TRY(const auto columns, find_columns(table, std::span(kChunkColumns).first(width)));
  EDGESPLAT_TRY(const auto values, read_columns(table, columns));
  for (const float value : values) {
    if (!std::isfinite(value)) return fail(Errc::kCorrupt, "a chunk of the compressed PLY is not finite");
  }
  if (has_colours) return values;
  std::vector<float> chunks;
  for (std::size_t row = 0; row < table.row_count; ++row) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * width);
    chunks.insert(chunks.end(), first, first + static_cast<std::ptrdiff_t>(width));
    chunks.insert(chunks.end(), {0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F});
  }
  return chunks;
}

void unpack_row(std::span<const std::uint32_t, 4> packed, std::span<const float> chunk, std::size_t row,
                GaussianCloud& cloud) {
  const Triple mean = mix(chunk, unpack_11_10_11(packed[0]));
  const auto quat = unpack_rotation_xyzw(packed[1]);
  const Triple scale = mix(chunk.subspan(6), unpack_11_10_11(packed[2]));
  const std::uint32_t rgba = packed[3];
  const Triple colour =
      mix(chunk.subspan(12), {unit(rgba >> 24U, 8), unit(rgba >> 16U, 8), unit(rgba >> 8U, 8)});
  float* sh = &cloud.sh[row * cloud.sh_floats_each()];
  for (std::size_t i = 0; i < 3; ++i) {
    cloud.means_m[row * 3 + i] = mean[i];
    cloud.log_scales[row * 3 + i] = scale[i];
    sh[i] = (colour[i] - 0.5F) / GaussianCloud::kShC0;
  }
  for (std::size_t i = 0; i < 4; ++i) cloud.quats_xyzw[row * 4 + i] = quat[i];
  cloud.opacity_logits[row] = logit_of_byte(static_cast<std::uint8_t>(rgba & 0xFFU));
  cloud.ids[row] = gaussian::GaussianId(0, row);
}

/// Element "sh": f_rest_* channel by channel, a byte each, 0..255 for -4..4.
Status fill_sh(const Table& table, GaussianCloud& cloud) {
  if (table.row_count != cloud.size()) {
    return fail(Errc::kCorrupt, "the compressed PLY has another number of sh rows than Gaussians");
  }
  const std::size_t bases = cloud.sh_floats_each() / 3 - 1;
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < 3 * bases; ++i) columns.push_back(*table.find("f_rest_" + std::to_string(i)));
  EDGESPLAT_TRY(const auto values, read_columns(table, columns));
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    for (std::size_t i = 0; i < 3 * bases; ++i) {
      const float byte = values[row * 3 * bases + i];
      // Bytes are cells of the range, but its two ends are exact.
      const float share = byte <= 0.0F ? 0.0F : byte >= 255.0F ? 1.0F : (byte + 0.5F) / 256.0F;
      cloud.sh[row * cloud.sh_floats_each() + (1 + i % bases) * 3 + i / bases] = (share - 0.5F) * 8.0F;
    }
  }
  return {};
}

}  // namespace

bool is_compressed(const File& file) {
  if (!file.has("chunk")) return false;
  const auto vertex = std::ranges::find(file.tables, "vertex", &Table::name);
  return vertex != file.tables.end() && vertex->find("packed_position").has_value();
}

Result<GaussianCloud> parse_compressed(const File& file) {
  EDGESPLAT_TRY(const auto chunk_table, find_table(file, "chunk"));
  EDGESPLAT_TRY(const auto vertices, find_table(file, "vertex"));
  EDGESPLAT_TRY(const auto chunks, read_chunks(chunk_table));
  if (vertices.row_count > chunk_table.row_count * kRowsAChunk) {
    return fail(Errc::kCorrupt, "the compressed PLY file has too few chunks for its Gaussians");
  }
  EDGESPLAT_TRY(const auto columns, find_columns(vertices, kPackedColumns));
  EDGESPLAT_TRY(const auto words, read_words(vertices, columns));
  GaussianCloud cloud;
  std::optional<Table> sh;
  if (file.has("sh")) {
    EDGESPLAT_TRY(sh, find_table(file, "sh"));
    EDGESPLAT_TRY(cloud.sh_degree, degree_of_rest_columns(*sh));
  }
  cloud.resize(vertices.row_count);
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const auto chunk = std::span(chunks).subspan(row / kRowsAChunk * kChunkFloats, kChunkFloats);
    unpack_row(std::span(words).subspan(4 * row).first<4>(), chunk, row, cloud);
  }
  if (sh && cloud.sh_degree > 0) EDGESPLAT_TRY_STATUS(fill_sh(*sh, cloud));
  return cloud;
}

}  // namespace edgesplat::io::ply
