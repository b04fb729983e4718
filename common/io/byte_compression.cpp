// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/byte_compression.hpp"

#include <bzlib.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <string>

namespace edgesplat::io {
namespace {

constexpr int kGzipWindow = 16 + MAX_WBITS;  // 16: a gzip header, not a zlib one
constexpr std::size_t kMaxPiece = std::numeric_limits<uInt>::max();

Bytef* to_zlib(std::span<const std::byte> bytes) {
  return reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));  // zlib's next_in is not const
}

/// Frees the stream's state, whichever way it went.
template <int (*kEnd)(z_stream*)>
struct ZlibStream {
  z_stream z{};
  ZlibStream() = default;
  ZlibStream(const ZlibStream&) = delete;
  ZlibStream& operator=(const ZlibStream&) = delete;
  ~ZlibStream() { kEnd(&z); }
};

struct Bzip2Stream {
  bz_stream z{};
  Bzip2Stream() = default;
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;
  ~Bzip2Stream() { BZ2_bzDecompressEnd(&z); }
};

}  // namespace

Result<std::vector<std::byte>> gzip(std::span<const std::byte> plain) {
  ZlibStream<deflateEnd> stream;
  z_stream& z = stream.z;
  if (deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, 9, Z_DEFAULT_STRATEGY) != Z_OK) {
    return fail(Errc::kIo, "no memory for a gzip stream");
  }
  if (plain.size() > kMaxPiece) return fail(Errc::kInvalidArgument, "more than 4 GiB for one gzip stream");
  std::vector<std::byte> out(deflateBound(&z, static_cast<uLong>(plain.size())));
  if (out.size() > kMaxPiece) return fail(Errc::kInvalidArgument, "more than 4 GiB for one gzip stream");
  z.next_in = to_zlib(plain);
  z.avail_in = static_cast<uInt>(plain.size());
  z.next_out = to_zlib(out);
  z.avail_out = static_cast<uInt>(out.size());
  if (deflate(&z, Z_FINISH) != Z_STREAM_END) return fail(Errc::kIo, "gzip did not finish");
  out.resize(out.size() - z.avail_out);
  return out;
}

Result<std::vector<std::byte>> gunzip(std::span<const std::byte> compressed, std::size_t max_bytes) {
  ZlibStream<inflateEnd> stream;
  z_stream& z = stream.z;
  if (inflateInit2(&z, kGzipWindow) != Z_OK) return fail(Errc::kIo, "no memory for a gzip stream");
  std::vector<std::byte> out;
  std::size_t filled = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    if (z.avail_in == 0) {
      const auto piece = compressed.first(std::min(compressed.size(), kMaxPiece));
      z.next_in = to_zlib(piece);
      z.avail_in = static_cast<uInt>(piece.size());
      compressed = compressed.subspan(piece.size());
    }
    if (filled == max_bytes) return fail(Errc::kCorrupt, "gzip: implausibly much comes out");
    if (filled == out.size()) {
      out.resize(std::min(max_bytes, std::max(std::size_t{1} << 16U, 2 * out.size())));
    }
    const std::size_t room = std::min(out.size() - filled, kMaxPiece);
    z.next_out = to_zlib(std::span(out).subspan(filled));
    z.avail_out = static_cast<uInt>(room);
    state = inflate(&z, Z_NO_FLUSH);
    filled += room - z.avail_out;
    if (state == Z_OK || state == Z_STREAM_END) continue;
    return fail(Errc::kCorrupt, state == Z_BUF_ERROR ? "gzip: truncated" : "gzip: damaged");
  }
  out.resize(filled);
  return out;
}

Result<std::vector<std::byte>> bunzip2(std::span<const std::byte> compressed, std::size_t plain_bytes) {
  if (compressed.size() > kMaxPiece) return fail(Errc::kCorrupt, "bzip2: too long");
  Bzip2Stream stream;
  bz_stream& z = stream.z;
  if (BZ2_bzDecompressInit(&z, 0, 0) != BZ_OK) return fail(Errc::kIo, "no memory for a bzip2 stream");
  z.next_in = reinterpret_cast<char*>(to_zlib(compressed));
  z.avail_in = static_cast<unsigned>(compressed.size());
  std::vector<std::byte> out;
  std::size_t filled = 0;
  while (true) {
    if (filled == out.size()) {
      // One byte over what is stated shows that more would come.
      out.resize(std::min(plain_bytes + 1, std::max(std::size_t{1} << 16U, 2 * out.size())));
      if (filled == out.size()) return fail(Errc::kCorrupt, "bzip2: another length than stated");
    }
    const std::size_t room = std::min(out.size() - filled, kMaxPiece);
    z.next_out = reinterpret_cast<char*>(out.data() + filled);
    z.avail_out = static_cast<unsigned>(room);
    const unsigned in_before = z.avail_in;
    const int state = BZ2_bzDecompress(&z);
    const std::size_t got = room - z.avail_out;
    filled += got;
    if (state == BZ_STREAM_END) break;
    if (state != BZ_OK) return fail(Errc::kCorrupt, "bzip2: damaged");
    if (got == 0 && z.avail_in == in_before) return fail(Errc::kCorrupt, "bzip2: truncated");
  }
  if (filled != plain_bytes) return fail(Errc::kCorrupt, "bzip2: another length than stated");
  out.resize(filled);
  return out;
}

Result<std::vector<std::byte>> zstd_compress(std::span<const std::byte> plain, int level) {
  std::vector<std::byte> out(ZSTD_compressBound(plain.size()));
  const std::size_t written = ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), level);
  if (ZSTD_isError(written) != 0) return fail(Errc::kIo, "zstd: " + std::string(ZSTD_getErrorName(written)));
  out.resize(written);
  return out;
}

Result<std::vector<std::byte>> zstd_decompress(std::span<const std::byte> compressed,
                                               std::size_t plain_bytes) {
  std::vector<std::byte> out(plain_bytes);
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), compressed.data(), compressed.size());
  if (ZSTD_isError(got) != 0) return fail(Errc::kCorrupt, "zstd: " + std::string(ZSTD_getErrorName(got)));
  if (got != plain_bytes) return fail(Errc::kCorrupt, "zstd: another length than stated");
  return out;
}

}  // namespace edgesplat::io
