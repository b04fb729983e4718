// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_codecs.hpp"

#include <turbojpeg.h>

#include <memory>
#include <string>
#include <utility>

namespace edgesplat::io::codec {
namespace {

struct DestroyTurbo {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Turbo = std::unique_ptr<void, DestroyTurbo>;

struct FreeTurbo {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

struct JpegHeader {
  int width_px = 0;
  int height_px = 0;
  int colour_space = 0;
};

const unsigned char* as_turbo(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

Result<JpegHeader> read_header(tjhandle turbo, std::span<const std::byte> bytes) {
  JpegHeader header;
  int subsampling = 0;
  if (tjDecompressHeader3(turbo, as_turbo(bytes), bytes.size(), &header.width_px, &header.height_px,
                          &subsampling, &header.colour_space) != 0) {
    return fail(Errc::kCorrupt, std::string("bad JPEG header: ") + tjGetErrorStr2(turbo));
  }
  EDGESPLAT_TRY_STATUS(check_size(header.width_px, header.height_px, Errc::kCorrupt));
  // A block of 8x8 pixels takes at least a bit or two; 2048 pixels a byte is far beyond any real picture.
  constexpr std::uint64_t kMaxPixelsPerByte = 2048;
  const auto pixels =
      static_cast<std::uint64_t>(header.width_px) * static_cast<std::uint64_t>(header.height_px);
  if (pixels / kMaxPixelsPerByte > bytes.size()) {
    return fail(Errc::kCorrupt, "a JPEG states more pixels than its bytes can hold");
  }
  return header;
}

template <typename Image>
Result<AnyImage> decode_as(tjhandle turbo, std::span<const std::byte> bytes, const JpegHeader& header) {
  Image image(header.width_px, header.height_px);
  const int format = Image::kChannels == 1 ? TJPF_GRAY : TJPF_RGB;
  // A warning (truncated or damaged data) counts as an error. Scans are limited: a small progressive file
  // with thousands of them takes minutes.
  if (tjDecompress2(turbo, as_turbo(bytes), bytes.size(), image.values.data(), header.width_px, 0,
                    header.height_px, format, TJFLAG_LIMITSCANS) != 0) {
    return fail(Errc::kCorrupt, std::string("damaged JPEG: ") + tjGetErrorStr2(turbo));
  }
  return AnyImage(std::move(image));
}

}  // namespace

bool is_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() >= 3 && bytes[0] == std::byte{0xFF} && bytes[1] == std::byte{0xD8} &&
         bytes[2] == std::byte{0xFF};
}

Result<ImageHeader> read_jpeg_header(std::span<const std::byte> bytes) {
  const Turbo turbo(tjInitDecompress());
  if (!turbo) return fail(Errc::kIo, "cannot start the JPEG decoder");
  EDGESPLAT_TRY(const auto header, read_header(turbo.get(), bytes));
  return ImageHeader{ImageFormat::kJpeg, header.width_px, header.height_px};
}

Result<AnyImage> decode_jpeg(std::span<const std::byte> bytes) {
  const Turbo turbo(tjInitDecompress());
  if (!turbo) return fail(Errc::kIo, "cannot start the JPEG decoder");
  EDGESPLAT_TRY(const auto header, read_header(turbo.get(), bytes));
  if (header.colour_space == TJCS_GRAY) return decode_as<sensor::ImageGray8>(turbo.get(), bytes, header);
  return decode_as<sensor::ImageRgb8>(turbo.get(), bytes, header);
}

Result<std::vector<std::byte>> encode_jpeg_rows(const std::uint8_t* first, int width_px, int height_px,
                                                int channels, int quality) {
  if (quality < 1 || quality > 100) {
    return fail(Errc::kInvalidArgument, "JPEG quality " + std::to_string(quality) + " is not in 1..100");
  }
  const Turbo turbo(tjInitCompress());
  if (!turbo) return fail(Errc::kIo, "cannot start the JPEG encoder");
  const int format = channels == 1 ? TJPF_GRAY : TJPF_RGB;
  const int subsampling = channels == 1 ? TJSAMP_GRAY : (quality >= 90 ? TJSAMP_444 : TJSAMP_420);
  unsigned char* raw = nullptr;
  unsigned long size = 0;
  const int result =
      tjCompress2(turbo.get(), first, width_px, 0, height_px, format, &raw, &size, subsampling, quality, 0);
  const std::unique_ptr<unsigned char, FreeTurbo> owned(raw);
  if (result != 0) return fail(Errc::kIo, std::string("cannot encode JPEG: ") + tjGetErrorStr2(turbo.get()));
  const auto encoded = std::as_bytes(std::span(raw, size));
  return std::vector<std::byte>(encoded.begin(), encoded.end());
}

}  // namespace edgesplat::io::codec
