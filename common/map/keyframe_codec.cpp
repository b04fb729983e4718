// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/keyframe_codec.hpp"

#include "common/base/bytes.hpp"
#include "common/base/crc32c.hpp"
#include "common/map/point_codec.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::map {
namespace {

// On the wire: never reuse a number.
enum class Tag : std::uint16_t { kCore = 1, kPoints = 2, kImage = 3, kCamera = 4 };

constexpr std::size_t kHeader_bytes = 16;  // magic, version, section count, length, CRC32C
constexpr std::size_t kCrcOffset_bytes = 12;
constexpr std::size_t kMaxSections = 64;
constexpr int kMaxImageEdge_px = 16384;

void write_transform(ByteWriter& out, const geometry::RigidTransform& transform) {
  for (int i = 0; i < 4; ++i) out.write(transform.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) out.write(transform.translation_m[i]);
}

geometry::RigidTransform read_transform(ByteReader& in) {
  geometry::RigidTransform transform;
  for (int i = 0; i < 4; ++i) transform.rotation.coeffs()[i] = in.read<double>();
  for (int i = 0; i < 3; ++i) transform.translation_m[i] = in.read<double>();
  return transform;
}

bool is_rigid(const geometry::RigidTransform& transform) {
  return transform.is_finite() && std::abs(transform.rotation.squaredNorm() - 1.0) < 1e-6;
}

std::vector<std::byte> encode_core(const Keyframe& keyframe) {
  ByteWriter out;
  out.write(keyframe.id.value);
  out.write(keyframe.pose_version);
  out.write(to_ns(keyframe.stamp));
  out.write(keyframe.exposure_s);
  write_transform(out, keyframe.odom_from_body);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) out.write(keyframe.pose_covariance(row, column));
  }
  return out.take();
}

Status decode_core(std::span<const std::byte> section, Keyframe& keyframe) {
  ByteReader in(section);
  keyframe.id.value = in.read<std::uint32_t>();
  keyframe.pose_version = in.read<std::uint32_t>();
  keyframe.stamp = host_time_from_ns(in.read<std::int64_t>());
  keyframe.exposure_s = in.read<float>();
  keyframe.odom_from_body = read_transform(in);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      const auto value = in.read<double>();
      keyframe.pose_covariance(row, column) = value;
      keyframe.pose_covariance(column, row) = value;
    }
  }
  if (!in.ok() || in.remaining() != 0) return fail(Errc::kCorrupt, "a keyframe's core has the wrong length");
  if (!is_rigid(keyframe.odom_from_body) || !keyframe.pose_covariance.allFinite() ||
      !std::isfinite(keyframe.exposure_s)) {
    return fail(Errc::kCorrupt, "a keyframe's pose, covariance or exposure is not a number");
  }
  return {};
}

std::vector<std::byte> encode_camera(const sensor::CameraMount& mount) {
  ByteWriter out;
  out.write(static_cast<std::uint8_t>(mount.model.kind == geometry::CameraKind::kFisheye ? 2 : 1));
  out.write(static_cast<std::int32_t>(mount.model.width_px));
  out.write(static_cast<std::int32_t>(mount.model.height_px));
  for (const double v : {mount.model.fx_px, mount.model.fy_px, mount.model.cx_px, mount.model.cy_px})
    out.write(v);
  for (const double v : mount.model.distortion) out.write(v);
  write_transform(out, mount.body_from_camera);
  out.write(mount.stamp_delay_s);
  return out.take();
}

Status decode_camera(std::span<const std::byte> section, Keyframe& keyframe) {
  ByteReader in(section);
  sensor::CameraMount mount;
  const auto kind = in.read<std::uint8_t>();
  mount.model.kind = kind == 2 ? geometry::CameraKind::kFisheye : geometry::CameraKind::kPinhole;
  mount.model.width_px = in.read<std::int32_t>();
  mount.model.height_px = in.read<std::int32_t>();
  for (double* v : {&mount.model.fx_px, &mount.model.fy_px, &mount.model.cx_px, &mount.model.cy_px}) {
    *v = in.read<double>();
  }
  for (double& v : mount.model.distortion) v = in.read<double>();
  mount.body_from_camera = read_transform(in);
  mount.stamp_delay_s = in.read<double>();
  if (!in.ok() || in.remaining() != 0 || kind < 1 || kind > 2) {
    return fail(Errc::kCorrupt, "a keyframe's camera has the wrong length or kind");
  }
  if (!mount.model.validate() || mount.model.width_px > kMaxImageEdge_px ||
      mount.model.height_px > kMaxImageEdge_px || !is_rigid(mount.body_from_camera) ||
      !std::isfinite(mount.stamp_delay_s)) {
    return fail(Errc::kCorrupt, "a keyframe's camera makes no sense");
  }
  keyframe.camera = mount;
  return {};
}

std::vector<std::byte> encode_image(const EncodedImage& image) {
  ByteWriter out;
  out.write(static_cast<std::uint8_t>(image.format));
  out.write(static_cast<std::int32_t>(image.width_px));
  out.write(static_cast<std::int32_t>(image.height_px));
  out.write_bytes(image.bytes);
  return out.take();
}

bool valid_image(const EncodedImage& image) {
  const bool known =
      image.format == EncodedImage::Format::kJpeg || image.format == EncodedImage::Format::kPng;
  return known && image.width_px > 0 && image.height_px > 0 && image.width_px <= kMaxImageEdge_px &&
         image.height_px <= kMaxImageEdge_px && !image.bytes.empty() &&
         image.bytes.size() <= kMaxKeyframeImage_bytes;
}

Status decode_image(std::span<const std::byte> section, Keyframe& keyframe) {
  ByteReader in(section);
  auto image = std::make_shared<EncodedImage>();
  image->format = static_cast<EncodedImage::Format>(in.read<std::uint8_t>());
  image->width_px = in.read<std::int32_t>();
  image->height_px = in.read<std::int32_t>();
  const auto bytes = in.take(in.remaining());
  image->bytes.assign(bytes.begin(), bytes.end());
  if (!in.ok() || !valid_image(*image)) return fail(Errc::kCorrupt, "a keyframe's image makes no sense");
  keyframe.image = std::move(image);
  return {};
}

Status decode_section(Tag tag, std::span<const std::byte> section, Keyframe& keyframe) {
  switch (tag) {
    case Tag::kCore:
      return decode_core(section, keyframe);
    case Tag::kPoints: {
      EDGESPLAT_TRY(keyframe.points_in_body, decode_points(section));
      return {};
    }
    case Tag::kImage:
      return decode_image(section, keyframe);
    case Tag::kCamera:
      return decode_camera(section, keyframe);
  }
  return {};  // a later version's section: skipped
}

void write_section(ByteWriter& out, Tag tag, std::span<const std::byte> content) {
  out.write(static_cast<std::uint16_t>(tag));
  out.write(static_cast<std::uint32_t>(content.size()));
  out.write_bytes(content);
}

Status check_encodable(const Keyframe& keyframe) {
  if (!is_rigid(keyframe.odom_from_body) || !keyframe.pose_covariance.allFinite() ||
      !std::isfinite(keyframe.exposure_s)) {
    return fail(Errc::kInvalidArgument, "keyframe " + std::to_string(keyframe.id.value) +
                                            " has a pose, covariance or exposure that is not a number");
  }
  if (keyframe.camera &&
      (!keyframe.camera->model.validate() || !is_rigid(keyframe.camera->body_from_camera))) {
    return fail(Errc::kInvalidArgument,
                "keyframe " + std::to_string(keyframe.id.value) + " has an invalid camera");
  }
  if (keyframe.image && !valid_image(*keyframe.image)) {
    return fail(Errc::kInvalidArgument, "keyframe " + std::to_string(keyframe.id.value) +
                                            " has an image that is empty or over 16 MiB");
  }
  return {};
}

/// Checks what frames the sections and returns them.
Result<std::span<const std::byte>> open_envelope(std::span<const std::byte> bytes,
                                                 std::size_t& section_count) {
  if (bytes.size() < kHeader_bytes || bytes.size() > kMaxKeyframe_bytes) {
    return fail(Errc::kCorrupt, "a keyframe of " + std::to_string(bytes.size()) + " bytes cannot be one");
  }
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kKeyframeMagic)
    return fail(Errc::kCorrupt, "not a keyframe: wrong magic number");
  if (const auto version = in.read<std::uint16_t>(); version != kKeyframeVersion) {
    return fail(Errc::kCorrupt, "keyframe of version " + std::to_string(version) + ", this program reads " +
                                    std::to_string(kKeyframeVersion) + ": update the older end");
  }
  section_count = in.read<std::uint16_t>();
  const auto length = in.read<std::uint32_t>();
  const auto stated_crc = in.read<std::uint32_t>();
  if (length != in.remaining()) return fail(Errc::kCorrupt, "a keyframe's length does not match");
  if (section_count > kMaxSections) return fail(Errc::kCorrupt, "a keyframe has too many sections");
  const auto sections = bytes.subspan(kHeader_bytes);
  if (stated_crc != crc32c(sections, crc32c(bytes.first(kCrcOffset_bytes)))) {
    return fail(Errc::kCorrupt, "a keyframe's CRC32C does not match");
  }
  return sections;
}

}  // namespace

Result<std::vector<std::byte>> encode_keyframe(const Keyframe& keyframe) {
  EDGESPLAT_TRY_STATUS(check_encodable(keyframe));
  EDGESPLAT_TRY(const auto points, encode_points(keyframe.points_in_body));
  ByteWriter out;
  out.write(kKeyframeMagic);
  out.write(kKeyframeVersion);
  out.write(static_cast<std::uint16_t>(2 + (keyframe.camera ? 1 : 0) + (keyframe.image ? 1 : 0)));
  out.write(std::uint32_t{0});
  out.write(std::uint32_t{0});
  write_section(out, Tag::kCore, encode_core(keyframe));
  if (keyframe.camera) write_section(out, Tag::kCamera, encode_camera(*keyframe.camera));
  write_section(out, Tag::kPoints, points);
  if (keyframe.image) write_section(out, Tag::kImage, encode_image(*keyframe.image));
  out.patch(8, static_cast<std::uint32_t>(out.size() - kHeader_bytes));
  const auto before = crc32c(out.bytes().first(kCrcOffset_bytes));
  out.patch(kCrcOffset_bytes, crc32c(out.bytes().subspan(kHeader_bytes), before));
  return out.take();
}

Result<Keyframe> decode_keyframe(std::span<const std::byte> bytes) {
  std::size_t section_count = 0;
  EDGESPLAT_TRY(const auto sections, open_envelope(bytes, section_count));
  Keyframe keyframe;
  ByteReader in(sections);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < section_count; ++i) {
    const auto tag = in.read<std::uint16_t>();
    const std::size_t length = in.read<std::uint32_t>();
    const auto section = in.take(length);
    if (!in.ok()) return fail(Errc::kCorrupt, "a keyframe's section reaches past its end");
    const std::uint64_t bit = tag < 64 ? std::uint64_t{1} << tag : 0;
    if ((seen & bit) != 0)
      return fail(Errc::kCorrupt, "a keyframe has the section " + std::to_string(tag) + " twice");
    seen |= bit;
    EDGESPLAT_TRY_STATUS(decode_section(static_cast<Tag>(tag), section, keyframe));
  }
  constexpr std::uint64_t kNeeded =
      (1U << static_cast<unsigned>(Tag::kCore)) | (1U << static_cast<unsigned>(Tag::kPoints));
  if ((seen & kNeeded) != kNeeded || in.remaining() != 0) {
    return fail(Errc::kCorrupt, "a keyframe lacks its core or points, or has bytes left over");
  }
  return keyframe;
}

}  // namespace edgesplat::map
