// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <string>

namespace edgesplat::io::mcap {
namespace {

/// Up to this ratio the stated length is believed and allocated at once; beyond it memory follows the
/// content.
constexpr std::uint64_t kPlausibleRatio = 64;

struct FreeZstdStream {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};
struct FreeLz4Stream {
  void operator()(LZ4F_dctx* stream) const { LZ4F_freeDecompressionContext(stream); }
};

tl::unexpected<Error> bad_chunk(std::string_view format, std::string_view reason) {
  return fail(Errc::kCorrupt,
              "a chunk cannot be decompressed (" + std::string(format) + "): " + std::string(reason));
}

/// A buffer for decompressing piece by piece that grows only as far as there is content.
class GrowingOutput {
 public:
  GrowingOutput(std::size_t compressed_bytes, std::uint64_t plain_bytes)
      : limit_(static_cast<std::size_t>(plain_bytes)) {
    constexpr std::size_t kFloorBytes = std::size_t{1} << 16U;
    bytes_.resize(std::min(limit_, std::max(kFloorBytes, compressed_bytes * 4)));
  }
  [[nodiscard]] std::span<std::byte> free_space() {
    if (filled_ == bytes_.size()) bytes_.resize(std::min(limit_, bytes_.size() * 2));
    return std::span(bytes_).subspan(filled_);
  }
  void filled(std::size_t count) { filled_ += count; }
  [[nodiscard]] bool full() const { return filled_ == limit_; }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::size_t limit_;
  std::size_t filled_ = 0;
  std::vector<std::byte> bytes_;
};

Result<std::vector<std::byte>> decompress_zstd(std::span<const std::byte> compressed,
                                               std::uint64_t plain_bytes) {
  if (plain_bytes <= std::uint64_t{compressed.size()} * kPlausibleRatio) {
    std::vector<std::byte> plain(static_cast<std::size_t>(plain_bytes));
    const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), compressed.data(), compressed.size());
    if (ZSTD_isError(got) != 0) return bad_chunk("zstd", ZSTD_getErrorName(got));
    if (got != plain.size()) return bad_chunk("zstd", "another length than stated");
    return plain;
  }
  const std::unique_ptr<ZSTD_DStream, FreeZstdStream> stream(ZSTD_createDStream());
  if (!stream) return fail(Errc::kIo, "no memory for a zstd stream");
  GrowingOutput output(compressed.size(), plain_bytes);
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  std::size_t hint = 1;
  while (hint != 0) {
    const auto space = output.free_space();
    ZSTD_outBuffer out{space.data(), space.size(), 0};
    const std::size_t in_before = in.pos;
    hint = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(hint) != 0) return bad_chunk("zstd", ZSTD_getErrorName(hint));
    output.filled(out.pos);
    if (hint != 0 && out.pos == 0 && in.pos == in_before) break;
  }
  if (hint != 0 || !output.full() || in.pos != in.size)
    return bad_chunk("zstd", "another length than stated");
  return output.take();
}

Result<std::vector<std::byte>> decompress_lz4(std::span<const std::byte> compressed,
                                              std::uint64_t plain_bytes) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) {
    return fail(Errc::kIo, "no memory for an lz4 stream");
  }
  const std::unique_ptr<LZ4F_dctx, FreeLz4Stream> stream(raw);
  GrowingOutput output(compressed.size(), plain_bytes);
  std::size_t hint = 1;
  while (hint != 0) {
    const auto space = output.free_space();
    std::size_t out_bytes = space.size();
    std::size_t in_bytes = compressed.size();
    hint = LZ4F_decompress(stream.get(), space.data(), &out_bytes, compressed.data(), &in_bytes, nullptr);
    if (LZ4F_isError(hint) != 0) return bad_chunk("lz4", LZ4F_getErrorName(hint));
    output.filled(out_bytes);
    compressed = compressed.subspan(in_bytes);
    if (hint != 0 && out_bytes == 0 && in_bytes == 0) break;
  }
  if (hint != 0 || !output.full() || !compressed.empty())
    return bad_chunk("lz4", "another length than stated");
  return output.take();
}

}  // namespace

std::string_view to_string(McapCompression compression) {
  switch (compression) {
    case McapCompression::kLz4:
      return "lz4";
    case McapCompression::kZstd:
      return "zstd";
    case McapCompression::kNone:
      break;
  }
  return "";
}

Result<McapCompression> compression_from_string(std::string_view name) {
  for (const auto known : {McapCompression::kNone, McapCompression::kLz4, McapCompression::kZstd}) {
    if (name == to_string(known)) return known;
  }
  return fail(Errc::kCorrupt, "unknown chunk compression '" + std::string(name.substr(0, 16)) + "'");
}

struct Compressor::ZstdContext {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZstdContext() = default;
  ZstdContext(const ZstdContext&) = delete;
  ZstdContext& operator=(const ZstdContext&) = delete;
  ~ZstdContext() { ZSTD_freeCCtx(context); }
};

Compressor::Compressor(McapCompression compression, int zstd_level)
    : compression_(compression), zstd_level_(zstd_level) {
  if (compression == McapCompression::kZstd) zstd_ = std::make_unique<ZstdContext>();
}
Compressor::Compressor(Compressor&&) noexcept = default;
Compressor::~Compressor() = default;

Status Compressor::append(std::span<const std::byte> plain, std::vector<std::byte>& out) {
  if (compression_ == McapCompression::kNone) {
    out.insert(out.end(), plain.begin(), plain.end());
    return {};
  }
  const std::size_t start = out.size();
  std::size_t written = 0;
  if (compression_ == McapCompression::kZstd) {
    out.resize(start + ZSTD_compressBound(plain.size()));
    written = ZSTD_compressCCtx(zstd_->context, out.data() + start, out.size() - start, plain.data(),
                                plain.size(), zstd_level_);
    if (ZSTD_isError(written) != 0) return fail(Errc::kIo, "zstd cannot compress a chunk");
  } else {
    out.resize(start + LZ4F_compressFrameBound(plain.size(), nullptr));
    written = LZ4F_compressFrame(out.data() + start, out.size() - start, plain.data(), plain.size(), nullptr);
    if (LZ4F_isError(written) != 0) return fail(Errc::kIo, "lz4 cannot compress a chunk");
  }
  out.resize(start + written);
  return {};
}

Result<std::vector<std::byte>> decompress(McapCompression compression, std::span<const std::byte> compressed,
                                          std::uint64_t plain_bytes) {
  if (plain_bytes > kMaxMcapRecordBytes) return bad_chunk(to_string(compression), "too large");
  switch (compression) {
    case McapCompression::kZstd:
      return decompress_zstd(compressed, plain_bytes);
    case McapCompression::kLz4:
      return decompress_lz4(compressed, plain_bytes);
    case McapCompression::kNone:
      break;
  }
  if (compressed.size() != plain_bytes) return bad_chunk("none", "another length than stated");
  return std::vector<std::byte>(compressed.begin(), compressed.end());
}

}  // namespace edgesplat::io::mcap
