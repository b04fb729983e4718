// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_codecs.hpp"

#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

// libpng reports errors by longjmp. Nothing with a destructor is created between setjmp and the last libpng
// call of a function: buffers and state live in the caller's frame.
namespace edgesplat::io::codec {
namespace {

/// What libpng reads from and complains to.
struct PngInput {
  std::span<const std::byte> bytes;
  char message[128] = "";
};

void keep_message(png_structp png, png_const_charp message) {
  auto* input = static_cast<PngInput*>(png_get_error_ptr(png));
  std::snprintf(input->message, sizeof(input->message), "%s", message);
  png_longjmp(png, 1);
}
void ignore_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep into, std::size_t count) {
  auto* input = static_cast<PngInput*>(png_get_io_ptr(png));
  if (count > input->bytes.size()) png_error(png, "the data ends early");
  std::memcpy(into, input->bytes.data(), count);
  input->bytes = input->bytes.subspan(count);
}

struct PngReader {
  explicit PngReader(std::span<const std::byte> bytes) : input{bytes} {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, keep_message, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  [[nodiscard]] tl::unexpected<Error> failure() const {
    return fail(Errc::kCorrupt, std::string("damaged PNG: ") + input.message);
  }

  PngInput input;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct PngLayout {
  png_uint_32 width_px = 0;
  png_uint_32 height_px = 0;
  int bits = 0;  ///< a channel in the file
  int colour_type = 0;
  std::size_t row_bytes = 0;  ///< after the transformations
  bool is_gray = false;
};

bool read_info(PngReader& reader, PngLayout& layout) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_user_limits(reader.png, kMaxImageSide_px, kMaxImageSide_px);
  png_set_chunk_malloc_max(reader.png, 1U << 20U);
  png_set_chunk_cache_max(reader.png, 128);
  png_set_read_fn(reader.png, &reader.input, read_bytes);
  png_read_info(reader.png, reader.info);
  png_get_IHDR(reader.png, reader.info, &layout.width_px, &layout.height_px, &layout.bits,
               &layout.colour_type, nullptr, nullptr, nullptr);
  return true;
}

/// Asks for gray8, gray16 or rgb8.
bool choose_output(PngReader& reader, PngLayout& layout) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  layout.is_gray = (layout.colour_type & PNG_COLOR_MASK_COLOR) == 0;
  if (layout.colour_type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(reader.png);
  if (layout.is_gray && layout.bits < 8) png_set_expand_gray_1_2_4_to_8(reader.png);
  if (layout.bits == 16) {
    if (layout.is_gray) {
      png_set_swap(reader.png);  // PNG is big-endian
    } else {
      png_set_strip_16(reader.png);
    }
  }
  png_set_strip_alpha(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  layout.row_bytes = png_get_rowbytes(reader.png, reader.info);
  return true;
}

bool read_rows(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

template <typename Image>
Result<AnyImage> read_pixels(PngReader& reader, const PngLayout& layout) {
  Image image(static_cast<int>(layout.width_px), static_cast<int>(layout.height_px));
  const std::size_t row_values = static_cast<std::size_t>(layout.width_px) * Image::kChannels;
  if (layout.row_bytes != row_values * sizeof(image.values[0])) {
    return fail(Errc::kCorrupt, "PNG with an unexpected row length");
  }
  std::vector<png_bytep> rows(layout.height_px);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = reinterpret_cast<png_bytep>(image.values.data() + y * row_values);
  }
  if (!read_rows(reader, rows.data())) return reader.failure();
  return AnyImage(std::move(image));
}

struct PngOutput {
  std::vector<std::byte> bytes;
};

void append_bytes(png_structp png, png_bytep from, std::size_t count) {
  auto* output = static_cast<PngOutput*>(png_get_io_ptr(png));
  const auto bytes = std::as_bytes(std::span(from, count));
  output->bytes.insert(output->bytes.end(), bytes.begin(), bytes.end());
}
void flush_nothing(png_structp) {}

struct PngWriter {
  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &errors, keep_message, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }

  PngInput errors;
  PngOutput output;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

bool write_rows(PngWriter& writer, const PngRows& rows, int level) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(writer.png, &writer.output, append_bytes, flush_nothing);
  png_set_compression_level(writer.png, level);
  png_set_filter(writer.png, 0,
                 level == 1 ? PNG_FILTER_SUB : PNG_FILTER_NONE | PNG_FILTER_SUB | PNG_FILTER_UP);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(rows.width_px),
               static_cast<png_uint_32>(rows.height_px), rows.bits,
               rows.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (rows.bits == 16) png_set_swap(writer.png);
  const auto row_bytes = static_cast<std::size_t>(rows.width_px * rows.channels * (rows.bits / 8));
  for (int y = 0; y < rows.height_px; ++y) {
    png_write_row(writer.png,
                  static_cast<png_const_bytep>(rows.first) + static_cast<std::size_t>(y) * row_bytes);
  }
  png_write_end(writer.png, writer.info);
  return true;
}

}  // namespace

bool is_png(std::span<const std::byte> bytes) {
  constexpr unsigned char kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  return bytes.size() >= sizeof(kSignature) && std::memcmp(bytes.data(), kSignature, sizeof(kSignature)) == 0;
}

Result<ImageHeader> read_png_header(std::span<const std::byte> bytes) {
  PngReader reader(bytes);
  PngLayout layout;
  if (reader.info == nullptr) return fail(Errc::kIo, "cannot start the PNG decoder");
  if (!read_info(reader, layout)) return reader.failure();
  return ImageHeader{ImageFormat::kPng, static_cast<int>(layout.width_px),
                     static_cast<int>(layout.height_px)};
}

Result<AnyImage> decode_png(std::span<const std::byte> bytes) {
  PngReader reader(bytes);
  PngLayout layout;
  if (reader.info == nullptr) return fail(Errc::kIo, "cannot start the PNG decoder");
  if (!read_info(reader, layout)) return reader.failure();
  // Deflate cannot exceed 1032:1, so a picture that states more than that is a lie (or a bomb).
  const std::uint64_t packed_bytes =
      std::uint64_t{png_get_rowbytes(reader.png, reader.info)} * layout.height_px;
  if (packed_bytes / 1032 > bytes.size()) {
    return fail(Errc::kCorrupt, "a PNG states more pixels than its bytes can hold");
  }
  if (!choose_output(reader, layout)) return reader.failure();
  if (!layout.is_gray) return read_pixels<sensor::ImageRgb8>(reader, layout);
  if (layout.bits == 16) return read_pixels<sensor::ImageGray16>(reader, layout);
  return read_pixels<sensor::ImageGray8>(reader, layout);
}

Result<std::vector<std::byte>> encode_png_rows(const PngRows& rows, int level) {
  if (level < 1 || level > 9) return fail(Errc::kInvalidArgument, "PNG level is not in 1..9");
  PngWriter writer;
  if (writer.info == nullptr) return fail(Errc::kIo, "cannot start the PNG encoder");
  if (!write_rows(writer, rows, level)) {
    return fail(Errc::kIo, std::string("cannot encode PNG: ") + writer.errors.message);
  }
  return std::move(writer.output.bytes);
}

}  // namespace edgesplat::io::codec
