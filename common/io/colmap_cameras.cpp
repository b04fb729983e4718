// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/colmap_model.hpp"
#include "common/io/colmap_text.hpp"
#include "common/io/image_file.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace edgesplat::io {
namespace {

using geometry::CameraKind;
using geometry::CameraModel;

constexpr std::size_t kMostParameters = 12;

/// What a parameter of a model is to ours; kOne says that both focal lengths are one number.
enum class Slot : std::uint8_t { kFx, kFy, kOneF, kCx, kCy, kK1, kK2, kP1, kP2, kK3, kK4, kZero };

struct ModelForm {
  int id;
  std::string_view name;
  CameraKind kind;
  std::size_t parameters;
  std::array<Slot, kMostParameters> slots;
};

using enum Slot;
constexpr std::array<ModelForm, 11> kModels{{
    {0, "SIMPLE_PINHOLE", CameraKind::kPinhole, 3, {kOneF, kCx, kCy}},
    {1, "PINHOLE", CameraKind::kPinhole, 4, {kFx, kFy, kCx, kCy}},
    {2, "SIMPLE_RADIAL", CameraKind::kPinhole, 4, {kOneF, kCx, kCy, kK1}},
    {3, "RADIAL", CameraKind::kPinhole, 5, {kOneF, kCx, kCy, kK1, kK2}},
    {4, "OPENCV", CameraKind::kPinhole, 8, {kFx, kFy, kCx, kCy, kK1, kK2, kP1, kP2}},
    {5, "OPENCV_FISHEYE", CameraKind::kFisheye, 8, {kFx, kFy, kCx, kCy, kK1, kK2, kK3, kK4}},
    {6,
     "FULL_OPENCV",
     CameraKind::kPinhole,
     12,
     {kFx, kFy, kCx, kCy, kK1, kK2, kP1, kP2, kK3, kZero, kZero, kZero}},
    {8, "SIMPLE_RADIAL_FISHEYE", CameraKind::kFisheye, 4, {kOneF, kCx, kCy, kK1}},
    {9, "RADIAL_FISHEYE", CameraKind::kFisheye, 5, {kOneF, kCx, kCy, kK1, kK2}},
    {14, "SIMPLE_FISHEYE", CameraKind::kFisheye, 3, {kOneF, kCx, kCy}},
    {15, "FISHEYE", CameraKind::kFisheye, 4, {kFx, kFy, kCx, kCy}},
}};

constexpr std::string_view kWayOut = ": undistort the images first (colmap image_undistorter)";

tl::unexpected<Error> bad_camera(std::uint32_t id, const std::string& why) {
  return fail(Errc::kCorrupt, "camera " + std::to_string(id) + ": " + why);
}

/// Where our camera keeps it; null for what must be zero.
double* place_of(Slot slot, CameraModel& camera) {
  const bool fisheye = camera.kind == CameraKind::kFisheye;
  switch (slot) {
    case kFx:
    case kOneF:
      return &camera.fx_px;
    case kFy:
      return &camera.fy_px;
    case kCx:
      return &camera.cx_px;
    case kCy:
      return &camera.cy_px;
    case kK1:
      return &camera.distortion[0];
    case kK2:
      return &camera.distortion[1];
    case kP1:
      return &camera.distortion[2];
    case kP2:
      return &camera.distortion[3];
    case kK3:
      return fisheye ? &camera.distortion[2] : &camera.k3;
    case kK4:
      return &camera.distortion[3];
    case kZero:
      break;
  }
  return nullptr;
}

/// A camera as the file has it, before it is made ours.
struct Record {
  std::uint32_t id = 0;
  std::uint64_t width_px = 0;
  std::uint64_t height_px = 0;
  std::array<double, kMostParameters> parameters{};
};

Result<CameraModel> to_camera(const ModelForm& form, const Record& record) {
  CameraModel camera;
  camera.kind = form.kind;
  const auto is_side = [](std::uint64_t px) { return px >= 1 && px <= kMaxImageSide_px; };
  if (!is_side(record.width_px) || !is_side(record.height_px))
    return bad_camera(record.id, "its size is not 1.." + std::to_string(kMaxImageSide_px) + " a side");
  camera.width_px = static_cast<int>(record.width_px);
  camera.height_px = static_cast<int>(record.height_px);
  for (std::size_t i = 0; i < form.parameters; ++i) {
    double* place = place_of(form.slots[i], camera);
    if (place == nullptr && record.parameters[i] != 0.0) {
      return bad_camera(record.id, "FULL_OPENCV with k4, k5 or k6 is not supported" + std::string(kWayOut));
    }
    if (place != nullptr) *place = record.parameters[i];
  }
  if (form.slots[0] == kOneF) camera.fy_px = camera.fx_px;
  camera.cx_px -= 0.5;  // pixel centres at 0.5 -> at 0
  camera.cy_px -= 0.5;
  if (const Status valid = camera.validate(); !valid) return bad_camera(record.id, valid.error().context);
  return camera;
}

Status add(const ModelForm* form, const Record& record, const std::string& name, ColmapCameras& cameras) {
  if (form == nullptr)
    return bad_camera(record.id, "model " + name.substr(0, 40) + " is not supported" + std::string(kWayOut));
  EDGESPLAT_TRY(const CameraModel camera, to_camera(*form, record));
  if (!cameras.emplace(record.id, camera).second) return bad_camera(record.id, "there are two of it");
  return {};
}

const ModelForm* find_model(auto value, auto field) {
  const auto* found = std::ranges::find(kModels, value, field);
  return found == kModels.end() ? nullptr : found;
}

Result<ColmapCameras> parse_binary(std::span<const std::byte> bytes) {
  constexpr std::size_t kLeastRecordBytes = 24 + 3 * 8;
  ByteReader in(bytes);
  const auto count = in.read<std::uint64_t>();
  if (!in.ok() || count > in.remaining() / kLeastRecordBytes)
    return fail(Errc::kCorrupt, "it is cut off, or no cameras.bin");
  ColmapCameras cameras;
  for (std::uint64_t i = 0; i < count; ++i) {
    Record record;
    record.id = in.read<std::uint32_t>();
    const auto model = in.read<std::int32_t>();
    record.width_px = in.read<std::uint64_t>();
    record.height_px = in.read<std::uint64_t>();
    const ModelForm* form = find_model(model, &ModelForm::id);
    for (std::size_t k = 0; form != nullptr && k < form->parameters; ++k)
      record.parameters[k] = in.read<double>();
    if (!in.ok()) return bad_camera(record.id, "it is cut off");
    EDGESPLAT_TRY_STATUS(add(form, record, std::to_string(model), cameras));
  }
  return cameras;
}

Result<ColmapCameras> parse_text(std::string_view text) {
  ColmapCameras cameras;
  colmap::LineReader lines(text);
  while (const auto line = lines.next()) {
    colmap::WordReader in(*line);
    Record record;
    record.id = in.read<std::uint32_t>();
    const std::string name(in.word());
    record.width_px = in.read<std::uint64_t>();
    record.height_px = in.read<std::uint64_t>();
    const ModelForm* form = find_model(std::string_view(name), &ModelForm::name);
    for (std::size_t k = 0; form != nullptr && k < form->parameters; ++k)
      record.parameters[k] = in.read<double>();
    if (!in.ok() || (form != nullptr && !in.rest().empty())) {
      return fail(Errc::kCorrupt, "line " + std::to_string(lines.number()) +
                                      " is not CAMERA_ID MODEL WIDTH HEIGHT and the model's parameters");
    }
    EDGESPLAT_TRY_STATUS(add(form, record, name, cameras));
  }
  return cameras;
}

}  // namespace

Result<ColmapCameras> parse_colmap_cameras(std::span<const std::byte> bytes, ColmapForm form) {
  return form == ColmapForm::kBinary ? parse_binary(bytes) : parse_text(colmap::as_text(bytes));
}

}  // namespace edgesplat::io
