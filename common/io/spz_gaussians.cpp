// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/spz_gaussians.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/spz_packed.hpp"

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U;

}  // namespace

Result<gaussian::GaussianCloud> parse_gaussians_spz(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(const auto packed, spz::open(bytes));
  return spz::unpack(packed);
}

Result<gaussian::GaussianCloud> read_gaussians_spz(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  auto cloud = parse_gaussians_spz(bytes);
  if (!cloud) return fail(cloud.error().code, path.string() + ": " + cloud.error().context);
  return cloud;
}

Status write_gaussians_spz(const std::filesystem::path& path, const gaussian::GaussianCloud& cloud,
                           std::uint32_t version) {
  EDGESPLAT_TRY(const auto packed, spz::pack(cloud, version));
  EDGESPLAT_TRY(const auto bytes, spz::close(packed));
  return write_file_atomically(path, bytes);
}

}  // namespace edgesplat::io
