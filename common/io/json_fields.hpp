// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

/// Reading JSON from outside without exceptions. Inside common/io only.
namespace edgesplat::io::json {

using Json = nlohmann::json;

/// An object; kCorrupt with the reason otherwise. `what` names the file's kind in errors.
[[nodiscard]] inline Result<Json> parse_object(std::string_view text, const std::string& what) {
  Json value = Json::parse(text, nullptr, false, true);
  if (value.is_discarded()) return fail(Errc::kCorrupt, what + " is not JSON");
  if (!value.is_object()) return fail(Errc::kCorrupt, what + " is not a JSON object");
  return value;
}

[[nodiscard]] inline const Json* find(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto field = object.find(key);
  return field == object.end() || field->is_null() ? nullptr : &*field;
}

/// A finite number, or nothing where the key is absent; kCorrupt for anything else.
[[nodiscard]] inline Result<std::optional<double>> number(const Json& object, std::string_view key) {
  const Json* field = find(object, key);
  if (field == nullptr) return std::optional<double>();
  if (!field->is_number() || !std::isfinite(field->get<double>())) {
    return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" is not a finite number");
  }
  return std::optional<double>(field->get<double>());
}

[[nodiscard]] inline Result<std::optional<std::string>> text(const Json& object, std::string_view key) {
  const Json* field = find(object, key);
  if (field == nullptr) return std::optional<std::string>();
  if (!field->is_string()) return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" is not a text");
  return std::optional<std::string>(field->get<std::string>());
}

}  // namespace edgesplat::io::json
