// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/aravis_features.hpp"

namespace edgesplat::aravis {
namespace {

std::string text(std::string_view name) {
  return std::string(name);
}

}  // namespace

Status ErrorSlot::status(std::string_view what) const {
  if (error_ == nullptr) return {};
  const bool missing = g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_FEATURE_NOT_FOUND) != 0;
  return fail(missing ? Errc::kNotFound : Errc::kUnavailable, text(what) + ": " + error_->message);
}

bool AravisFeatures::has(std::string_view name) const {
  const ErrorSlot ignored;
  ErrorSlot error;
  return arv_camera_is_feature_available(camera_, text(name).c_str(), error.out()) != 0 &&
         error.status(name).has_value();
}

std::vector<std::string> AravisFeatures::choices(std::string_view name) const {
  if (!has(name)) return {};
  ErrorSlot error;
  guint count = 0;
  const std::unique_ptr<const char*, decltype(&g_free)> entries(
      arv_camera_dup_available_enumerations_as_strings(camera_, text(name).c_str(), &count, error.out()),
      &g_free);
  if (!entries || !error.status(name)) return {};
  return {entries.get(), entries.get() + count};
}

Status AravisFeatures::set(std::string_view name, bool value) {
  ErrorSlot error;
  arv_camera_set_boolean(camera_, text(name).c_str(), value ? 1 : 0, error.out());
  return error.status(name);
}

Status AravisFeatures::set(std::string_view name, std::int64_t value) {
  ErrorSlot error;
  arv_camera_set_integer(camera_, text(name).c_str(), value, error.out());
  return error.status(name);
}

Status AravisFeatures::set(std::string_view name, double value) {
  ErrorSlot error;
  arv_camera_set_float(camera_, text(name).c_str(), value, error.out());
  return error.status(name);
}

Status AravisFeatures::choose(std::string_view name, std::string_view entry) {
  ErrorSlot error;
  arv_camera_set_string(camera_, text(name).c_str(), text(entry).c_str(), error.out());
  return error.status(text(name) + " = " + text(entry));
}

Status AravisFeatures::execute(std::string_view name) {
  ErrorSlot error;
  arv_camera_execute_command(camera_, text(name).c_str(), error.out());
  return error.status(name);
}

Result<std::int64_t> AravisFeatures::integer(std::string_view name) {
  ErrorSlot error;
  const gint64 value = arv_camera_get_integer(camera_, text(name).c_str(), error.out());
  EDGESPLAT_TRY_STATUS(error.status(name));
  return value;
}

Result<double> AravisFeatures::number(std::string_view name) {
  ErrorSlot error;
  const double value = arv_camera_get_float(camera_, text(name).c_str(), error.out());
  EDGESPLAT_TRY_STATUS(error.status(name));
  return value;
}

Result<std::string> AravisFeatures::chosen(std::string_view name) {
  ErrorSlot error;
  const char* value = arv_camera_get_string(camera_, text(name).c_str(), error.out());
  EDGESPLAT_TRY_STATUS(error.status(name));
  return std::string(value == nullptr ? "" : value);
}

}  // namespace edgesplat::aravis
