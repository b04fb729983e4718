// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/splat_gaussians.hpp"

#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/gaussian_values.hpp"

#include <array>
#include <cmath>
#include <string>

namespace edgesplat::io {
namespace {

using gaussian::GaussianCloud;

constexpr std::size_t kRecordBytes = 32;
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U;
constexpr float kSmallestLogScale = -20.0F;

tl::unexpected<Error> bad_row(std::size_t row, const std::string& what) {
  return fail(Errc::kCorrupt, ".splat: Gaussian " + std::to_string(row) + " " + what);
}

Status read_row(ByteReader& reader, std::size_t row, GaussianCloud& cloud) {
  cloud.ids[row] = gaussian::GaussianId(0, row);
  for (std::size_t i = 0; i < 3; ++i) cloud.means_m[3 * row + i] = reader.read<float>();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto scale = reader.read<float>();
    if (!std::isfinite(scale) || !std::isfinite(cloud.means_m[3 * row + i])) {
      return bad_row(row, "is not finite");
    }
    if (scale < 0.0F) return bad_row(row, "has a negative scale");
    cloud.log_scales[3 * row + i] = std::max(kSmallestLogScale, std::log(scale));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto colour = static_cast<float>(reader.read<std::uint8_t>()) / 255.0F;
    cloud.sh[3 * row + i] = (colour - 0.5F) / GaussianCloud::kShC0;
  }
  cloud.opacity_logits[row] = logit_of_byte(reader.read<std::uint8_t>());
  std::array<float, 4> wxyz{};
  float norm2 = 0.0F;
  for (float& value : wxyz) {
    value = (static_cast<float>(reader.read<std::uint8_t>()) - 128.0F) / 128.0F;
    norm2 += value * value;
  }
  if (norm2 == 0.0F) return bad_row(row, "has no rotation");
  for (std::size_t i = 0; i < 4; ++i) cloud.quats_xyzw[4 * row + i] = wxyz[(i + 1) % 4] / std::sqrt(norm2);
  return {};
}

void write_row(const GaussianCloud& cloud, std::size_t row, ByteWriter& writer) {
  for (std::size_t i = 0; i < 3; ++i) writer.write(cloud.means_m[3 * row + i]);
  for (std::size_t i = 0; i < 3; ++i) writer.write(std::exp(cloud.log_scales[3 * row + i]));
  const float* sh = &cloud.sh[row * cloud.sh_floats_each()];
  for (std::size_t i = 0; i < 3; ++i) writer.write(to_byte(255.0F * (0.5F + GaussianCloud::kShC0 * sh[i])));
  writer.write(byte_of_logit(cloud.opacity_logits[row]));
  const float* q = &cloud.quats_xyzw[4 * row];
  const float norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  for (const std::size_t i : {3U, 0U, 1U, 2U}) writer.write(to_byte(q[i] / norm * 128.0F + 128.0F));
}

}  // namespace

Result<GaussianCloud> parse_gaussians_splat(std::span<const std::byte> bytes) {
  if (bytes.size() % kRecordBytes != 0) {
    return fail(Errc::kCorrupt, ".splat: " + std::to_string(bytes.size()) + " bytes are no multiple of " +
                                    std::to_string(kRecordBytes) + ": truncated or another format");
  }
  GaussianCloud cloud;
  cloud.resize(bytes.size() / kRecordBytes);
  ByteReader reader(bytes);
  for (std::size_t row = 0; row < cloud.size(); ++row) EDGESPLAT_TRY_STATUS(read_row(reader, row, cloud));
  return cloud;
}

Result<GaussianCloud> read_gaussians_splat(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  auto cloud = parse_gaussians_splat(bytes);
  if (!cloud) return fail(cloud.error().code, path.string() + ": " + cloud.error().context);
  return cloud;
}

Status write_gaussians_splat(const std::filesystem::path& path, const GaussianCloud& cloud) {
  EDGESPLAT_TRY_STATUS(check_writable(cloud));
  ByteWriter writer;
  writer.reserve(cloud.size() * kRecordBytes);
  for (std::size_t row = 0; row < cloud.size(); ++row) write_row(cloud, row, writer);
  return write_file_atomically(path, writer.bytes());
}

}  // namespace edgesplat::io
