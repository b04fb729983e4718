// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_codecs.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace edgesplat::io {
namespace {

using sensor::ImageGray16;
using sensor::ImageGray8;
using sensor::ImageRgb8;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30U;

template <typename T>
ImageRgb8 replicate_grey(const sensor::Image<T, 1>& grey) {
  constexpr unsigned kShift = (sizeof(T) - 1) * 8;
  ImageRgb8 rgb(grey.width_px, grey.height_px);
  auto out = rgb.values.begin();
  for (const T value : grey.values) {
    out = std::fill_n(out, 3, static_cast<std::uint8_t>(value >> kShift));
  }
  return rgb;
}

ImageRgb8 to_rgb8(AnyImage image) {
  if (auto* rgb = std::get_if<ImageRgb8>(&image)) return std::move(*rgb);
  if (const auto* grey = std::get_if<ImageGray8>(&image)) return replicate_grey(*grey);
  return replicate_grey(std::get<ImageGray16>(image));
}

template <typename Image>
Result<Image> decode_exactly(std::span<const std::byte> bytes, std::string_view kind) {
  EDGESPLAT_TRY(auto image, decode_image(bytes));
  if (auto* wanted = std::get_if<Image>(&image)) return std::move(*wanted);
  return fail(Errc::kCorrupt, "the picture is not " + std::string(kind));
}

/// A picture whose pixels somebody resized by hand would be read beyond its end.
template <typename Image>
Status check_pixels(const Image& image) {
  EDGESPLAT_TRY_STATUS(codec::check_size(image.width_px, image.height_px, Errc::kInvalidArgument));
  const auto expected = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px) *
                        static_cast<std::size_t>(Image::kChannels);
  if (image.values.size() == expected) return {};
  return fail(Errc::kInvalidArgument, "a picture's pixels do not match its size");
}

template <typename Image>
Result<std::vector<std::byte>> encode_jpeg_image(const Image& image, int quality) {
  EDGESPLAT_TRY_STATUS(check_pixels(image));
  return codec::encode_jpeg_rows(image.values.data(), image.width_px, image.height_px, Image::kChannels,
                                 quality);
}

template <typename Image>
Result<std::vector<std::byte>> encode_png_image(const Image& image, int level) {
  EDGESPLAT_TRY_STATUS(check_pixels(image));
  return codec::encode_png_rows({image.values.data(), image.width_px, image.height_px, Image::kChannels,
                                 static_cast<int>(sizeof(image.values[0]) * 8)},
                                level);
}

Result<std::vector<std::byte>> encode_by_extension(const std::string& extension, const AnyImage& image) {
  if (extension == ".png") {
    return std::visit([](const auto& typed) { return encode_png(typed); }, image);
  }
  if (extension == ".jpg" || extension == ".jpeg") {
    if (const auto* rgb = std::get_if<ImageRgb8>(&image)) return encode_jpeg(*rgb);
    if (const auto* grey = std::get_if<ImageGray8>(&image)) return encode_jpeg(*grey);
    return fail(Errc::kInvalidArgument, "JPEG cannot hold 16 bits: use .png");
  }
  return fail(Errc::kInvalidArgument, "unknown picture extension '" + extension + "': use .jpg or .png");
}

/// Puts the path in front of an error's sentence.
template <typename T>
Result<T> with_path(Result<T> result, const std::filesystem::path& path) {
  if (result) return result;
  return fail(result.error().code, path.string() + ": " + result.error().context);
}

}  // namespace

Status codec::check_size(int width_px, int height_px, Errc code) {
  if (width_px >= 1 && height_px >= 1 && width_px <= kMaxImageSide_px && height_px <= kMaxImageSide_px)
    return {};
  return fail(code, "a picture of " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                        " pixels: each side must be 1 to " + std::to_string(kMaxImageSide_px));
}

Result<ImageHeader> read_image_header(std::span<const std::byte> bytes) {
  if (codec::is_jpeg(bytes)) return codec::read_jpeg_header(bytes);
  if (codec::is_png(bytes)) return codec::read_png_header(bytes);
  return fail(Errc::kCorrupt, "neither JPEG nor PNG");
}

Result<AnyImage> decode_image(std::span<const std::byte> bytes) {
  if (codec::is_jpeg(bytes)) return codec::decode_jpeg(bytes);
  if (codec::is_png(bytes)) return codec::decode_png(bytes);
  return fail(Errc::kCorrupt, "neither JPEG nor PNG");
}

Result<ImageRgb8> decode_rgb8(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(auto image, decode_image(bytes));
  return to_rgb8(std::move(image));
}
Result<ImageGray8> decode_gray8(std::span<const std::byte> bytes) {
  return decode_exactly<ImageGray8>(bytes, "8-bit grey");
}
Result<ImageGray16> decode_gray16(std::span<const std::byte> bytes) {
  return decode_exactly<ImageGray16>(bytes, "16-bit grey");
}

Result<std::vector<std::byte>> encode_jpeg(const ImageRgb8& image, int quality) {
  return encode_jpeg_image(image, quality);
}
Result<std::vector<std::byte>> encode_jpeg(const ImageGray8& image, int quality) {
  return encode_jpeg_image(image, quality);
}
Result<std::vector<std::byte>> encode_png(const ImageRgb8& image, int level) {
  return encode_png_image(image, level);
}
Result<std::vector<std::byte>> encode_png(const ImageGray8& image, int level) {
  return encode_png_image(image, level);
}
Result<std::vector<std::byte>> encode_png(const ImageGray16& image, int level) {
  return encode_png_image(image, level);
}

Result<AnyImage> load_image(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  return with_path(decode_image(bytes), path);
}

Result<ImageRgb8> load_rgb8(const std::filesystem::path& path) {
  EDGESPLAT_TRY(auto image, load_image(path));
  return to_rgb8(std::move(image));
}

Status save_image(const std::filesystem::path& path, const AnyImage& image) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  EDGESPLAT_TRY(const auto bytes, with_path(encode_by_extension(extension, image), path));
  return write_file_atomically(path, bytes);
}

}  // namespace edgesplat::io
