// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/unpacked_file.hpp"

#include "common/base/unique_fd.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/byte_source.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxRatio = 64;
constexpr std::uint64_t kFloorBytes = std::uint64_t{64} << 20U;

struct FreeStream {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

Status unpack_zstd(const ByteSource& packed, int out, const std::filesystem::path& path) {
  const std::unique_ptr<ZSTD_DStream, FreeStream> stream(ZSTD_createDStream());
  if (!stream) return fail(Errc::kIo, "no memory for a zstd stream");
  const std::uint64_t limit = std::max(kFloorBytes, kMaxRatio * packed.size_bytes());
  std::vector<std::byte> plain(ZSTD_DStreamOutSize());
  std::uint64_t written = 0;
  std::size_t hint = 1;
  for (std::uint64_t at = 0; at < packed.size_bytes();) {
    EDGESPLAT_TRY(const auto piece,
                  packed.read(at, std::min<std::uint64_t>(packed.size_bytes() - at, ZSTD_DStreamInSize())));
    at += piece.size();
    ZSTD_inBuffer in{piece.data(), piece.size(), 0};
    bool full = true;
    while (in.pos < in.size || full) {
      ZSTD_outBuffer to{plain.data(), plain.size(), 0};
      hint = ZSTD_decompressStream(stream.get(), &to, &in);
      if (ZSTD_isError(hint) != 0)
        return fail(Errc::kCorrupt, std::string("zstd: ") + ZSTD_getErrorName(hint));
      written += to.pos;
      if (written > limit) return fail(Errc::kCorrupt, "zstd: implausibly much comes out");
      EDGESPLAT_TRY_STATUS(write_all(out, std::span(plain).first(to.pos), path));
      full = to.pos == to.size && hint != 0;
    }
  }
  if (hint != 0) return fail(Errc::kCorrupt, "zstd: truncated");
  return {};
}

}  // namespace

Result<UnpackedFile> UnpackedFile::from_zstd(const std::filesystem::path& packed) {
  EDGESPLAT_TRY(const auto source, open_byte_source(packed));
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  if (error) return fail(Errc::kIo, "no folder for temporary files: " + error.message());
  std::string name = (folder / "edgesplat-bag-XXXXXX").string();
  const UniqueFd fd(::mkstemp(name.data()));
  if (!fd.valid()) return fail(Errc::kIo, "cannot make a temporary file in " + folder.string());
  UnpackedFile file{std::filesystem::path(name)};
  EDGESPLAT_TRY_STATUS(unpack_zstd(*source, fd.get(), file.path_));
  return file;
}

UnpackedFile::~UnpackedFile() {
  std::error_code error;
  if (!path_.empty()) std::filesystem::remove(path_, error);
}

}  // namespace edgesplat::io
