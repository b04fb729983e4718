// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/map_sidecar.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/json_fields.hpp"

namespace edgesplat::io {
namespace {

constexpr std::string_view kKind = "edgesplat map";
constexpr int kVersion = 1;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 16U;

Status take_text(const json::Json& object, std::string_view key, std::string& into) {
  EDGESPLAT_TRY(auto value, json::text(object, key));
  if (value) into = *std::move(value);
  return {};
}

Status take_count(const json::Json& object, std::string_view key, std::uint64_t& into) {
  const json::Json* field = json::find(object, key);
  if (field == nullptr) return {};
  if (!field->is_number_unsigned())
    return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" is not a count");
  into = field->get<std::uint64_t>();
  return {};
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& map_file) {
  return map_file.string() + ".json";
}

Status write_sidecar(const std::filesystem::path& map_file, const MapSidecar& sidecar) {
  const nlohmann::ordered_json object = {{"kind", kKind},
                                         {"version", kVersion},
                                         {"gaussians", sidecar.gaussians},
                                         {"frame", sidecar.frame},
                                         {"units", sidecar.units},
                                         {"axes", sidecar.axes},
                                         {"stored_as", sidecar.stored_as},
                                         {"sh_degree", sidecar.sh_degree},
                                         {"colour_space", sidecar.colour_space},
                                         {"epoch", sidecar.epoch},
                                         {"sky_included", sidecar.sky_included}};
  const auto text = object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  return write_file_atomically(sidecar_path(map_file), text);
}

Result<MapSidecar> parse_sidecar(std::string_view text) {
  EDGESPLAT_TRY(const auto object, json::parse_object(text, "the map's sidecar"));
  EDGESPLAT_TRY(const auto kind, json::text(object, "kind"));
  if (kind != kKind)
    return fail(Errc::kCorrupt, "the map's sidecar has no \"kind\": \"" + std::string(kKind) + "\"");
  std::uint64_t version = 0;
  EDGESPLAT_TRY_STATUS(take_count(object, "version", version));
  if (version != kVersion) {
    return fail(Errc::kCorrupt, "the map's sidecar has version " + std::to_string(version) + ", expected " +
                                    std::to_string(kVersion));
  }
  MapSidecar sidecar;
  EDGESPLAT_TRY_STATUS(take_text(object, "frame", sidecar.frame));
  EDGESPLAT_TRY_STATUS(take_text(object, "units", sidecar.units));
  EDGESPLAT_TRY_STATUS(take_text(object, "axes", sidecar.axes));
  EDGESPLAT_TRY_STATUS(take_text(object, "stored_as", sidecar.stored_as));
  EDGESPLAT_TRY_STATUS(take_text(object, "colour_space", sidecar.colour_space));
  EDGESPLAT_TRY_STATUS(take_count(object, "epoch", sidecar.epoch));
  EDGESPLAT_TRY_STATUS(take_count(object, "gaussians", sidecar.gaussians));
  std::uint64_t degree = 0;
  EDGESPLAT_TRY_STATUS(take_count(object, "sh_degree", degree));
  if (degree > 3) return fail(Errc::kCorrupt, "\"sh_degree\" is above 3");
  sidecar.sh_degree = static_cast<int>(degree);
  if (const json::Json* sky = json::find(object, "sky_included")) {
    if (!sky->is_boolean()) return fail(Errc::kCorrupt, "\"sky_included\" is neither true nor false");
    sidecar.sky_included = sky->get<bool>();
  }
  return sidecar;
}

Result<std::optional<MapSidecar>> read_sidecar(const std::filesystem::path& map_file) {
  const auto path = sidecar_path(map_file);
  const auto text = read_text_file(path, kMaxBytes);
  if (!text && text.error().code == Errc::kNotFound) return std::optional<MapSidecar>();
  if (!text) return tl::unexpected(text.error());
  auto sidecar = parse_sidecar(*text);
  if (!sidecar) return fail(sidecar.error().code, path.string() + ": " + sidecar.error().context);
  return std::optional(*std::move(sidecar));
}

}  // namespace edgesplat::io
