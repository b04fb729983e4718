// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/camera_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace edgesplat::aravis {
namespace {

using Names = std::initializer_list<std::string_view>;

struct ChunkNames {
  Chunk chunk;
  std::array<std::string_view, 2> entries;  ///< of ChunkSelector: today's name, an older one
};

/// Writes with fallbacks, and remembers what did not work.
class Setter {
 public:
  Setter(FeatureAccess& features, CameraAbilities& abilities) : features_(features), abilities_(abilities) {}

  /// The first of the names that the camera has; empty where it has none.
  [[nodiscard]] std::string find(Names names) const {
    for (const std::string_view name : names)
      if (features_.has(name)) return std::string(name);
    return {};
  }
  /// A setting that pictures are usable without.
  void wish(std::string_view what, const Status& status) {
    if (!status) abilities_.without.push_back(std::string(what) + ": " + status.error().context);
  }
  template <typename T>
  void wish_if_there(std::string_view name, T value) {
    if (features_.has(name)) wish(name, features_.set(name, value));
  }
  void choose_if_there(std::string_view name, std::string_view entry) {
    if (features_.has(name)) wish(name, features_.choose(name, entry));
  }
  FeatureAccess& features() { return features_; }

 private:
  FeatureAccess& features_;
  CameraAbilities& abilities_;
};

void set_up_clock(Setter& s, CameraAbilities& abilities, const GigeCameraConfig& config) {
  FeatureAccess& features = s.features();
  abilities.clock_latch = s.find({"TimestampLatch", "GevTimestampControlLatch"});
  abilities.clock_value = s.find({"TimestampLatchValue", "GevTimestampValue"});
  if (!config.ptp) return;
  abilities.ptp_enable = s.find({"PtpEnable", "GevIEEE1588", "PtpMode"});
  if (abilities.ptp_enable.empty()) {
    abilities.without.emplace_back("PTP: the camera has none");
    return;
  }
  const bool is_mode = abilities.ptp_enable == "PtpMode";
  const Status enabled =
      is_mode ? features.choose("PtpMode", "Slave") : features.set(abilities.ptp_enable, true);
  if (!enabled) {
    s.wish(abilities.ptp_enable, enabled);
    return;
  }
  // The robot's switch or computer is the master: where a camera can be told not to try, it is.
  s.wish_if_there("PtpSlaveOnly", true);
  s.wish_if_there("GevIEEE1588SlaveOnly", true);
  abilities.ptp_latch = s.find({"PtpDataSetLatch", "GevIEEE1588DataSetLatch"});
  abilities.ptp_status = s.find({"PtpStatus", "GevIEEE1588StatusLatched", "GevIEEE1588Status"});
  abilities.ptp_offset = s.find({"PtpOffsetFromMaster", "GevIEEE1588OffsetFromMaster"});
}

Status set_up_trigger(Setter& s, const GigeCameraConfig& config) {
  FeatureAccess& features = s.features();
  s.choose_if_there("AcquisitionMode", "Continuous");
  const bool by_line = config.trigger == Trigger::kLine;
  // Every other trigger off: one that is left on from an earlier use stops the camera.
  const std::vector<std::string> selectors = features.choices("TriggerSelector");
  std::string frame_start;
  for (const std::string_view wanted : {"FrameStart", "FrameBurstStart", "AcquisitionStart"})
    if (frame_start.empty() && std::ranges::find(selectors, wanted) != selectors.end()) frame_start = wanted;
  for (const std::string& selector : selectors) {
    s.wish("TriggerSelector", features.choose("TriggerSelector", selector));
    if (!by_line || selector != frame_start) s.choose_if_there("TriggerMode", "Off");
  }
  if (!by_line) {
    s.choose_if_there("TriggerMode", "Off");
    s.wish_if_there("AcquisitionFrameRateEnable", true);
    const std::string rate = s.find({"AcquisitionFrameRate", "AcquisitionFrameRateAbs"});
    if (!rate.empty()) s.wish(rate, features.set(rate, config.frame_rate_hz));
    return {};
  }
  s.wish_if_there("AcquisitionFrameRateEnable", false);
  if (!frame_start.empty()) EDGESPLAT_TRY_STATUS(features.choose("TriggerSelector", frame_start));
  EDGESPLAT_TRY_STATUS(features.choose("TriggerSource", config.trigger_source));
  s.choose_if_there("TriggerActivation", "RisingEdge");
  const std::string delay = s.find({"TriggerDelay", "TriggerDelayAbs"});
  if (!delay.empty()) s.wish(delay, features.set(delay, 0.0));
  return features.choose("TriggerMode", "On");
}

Status set_up_exposure(Setter& s, CameraAbilities& abilities, const GigeCameraConfig& config) {
  FeatureAccess& features = s.features();
  s.choose_if_there("ExposureMode", "Timed");
  abilities.exposure = s.find({"ExposureTime", "ExposureTimeAbs"});
  const bool automatic = config.exposure_us <= 0.0;
  s.choose_if_there("ExposureAuto", automatic ? "Continuous" : "Off");
  if (!automatic) {
    if (abilities.exposure.empty())
      return fail(Errc::kNotFound,
                  "the camera has neither ExposureTime nor ExposureTimeAbs; set exposure_us = 0");
    EDGESPLAT_TRY_STATUS(features.set(abilities.exposure, config.exposure_us));
  }
  const bool automatic_gain = config.gain_db < 0.0;
  s.choose_if_there("GainAuto", automatic_gain ? "Continuous" : "Off");
  abilities.gain = s.find({"Gain", "GainRaw"});
  if (automatic_gain || abilities.gain.empty()) return {};
  if (abilities.gain == "Gain") {
    s.wish("Gain", features.set("Gain", config.gain_db));
  } else {
    s.wish("GainRaw",
           features.set("GainRaw", std::int64_t{std::llround(config.gain_db * config.gain_raw_per_db)}));
  }
  return {};
}

void set_up_chunks(Setter& s, CameraAbilities& abilities) {
  FeatureAccess& features = s.features();
  if (!features.has("ChunkModeActive")) return;
  const Status active = features.set("ChunkModeActive", true);
  s.wish("ChunkModeActive", active);
  if (!active) return;
  const std::array<ChunkNames, 5> wanted{
      ChunkNames{Chunk::kTimestamp, {"Timestamp", "Timestamp"}},
      ChunkNames{Chunk::kExposureTime, {"ExposureTime", "ExposureTime"}},
      ChunkNames{Chunk::kGain, {"Gain", "GainAll"}}, ChunkNames{Chunk::kFrameId, {"FrameID", "Framecounter"}},
      ChunkNames{Chunk::kCounter, {"CounterValue", "Triggerinputcounter"}}};
  const std::vector<std::string> there = features.choices("ChunkSelector");
  for (const auto& [chunk, entries] : wanted) {
    for (const std::string_view entry : entries) {
      if (std::ranges::find(there, entry) == there.end()) continue;
      Status enabled = features.choose("ChunkSelector", entry);
      if (enabled) enabled = features.set("ChunkEnable", true);
      s.wish(entry, enabled);
      if (enabled) abilities.chunks.push_back(chunk);
      break;
    }
  }
}

}  // namespace

bool CameraAbilities::has(Chunk chunk) const {
  return std::ranges::find(chunks, chunk) != chunks.end();
}

Result<CameraAbilities> set_up_camera(FeatureAccess& features, const GigeCameraConfig& config) {
  CameraAbilities abilities;
  Setter setter(features, abilities);
  set_up_clock(setter, abilities, config);
  EDGESPLAT_TRY_STATUS(features.choose("PixelFormat", to_string(config.pixel_format)));
  EDGESPLAT_TRY_STATUS(set_up_trigger(setter, config));
  EDGESPLAT_TRY_STATUS(set_up_exposure(setter, abilities, config));
  set_up_chunks(setter, abilities);
  return abilities;
}

Result<PtpReading> read_ptp(FeatureAccess& features, const CameraAbilities& abilities) {
  if (!abilities.ptp_latch.empty()) EDGESPLAT_TRY_STATUS(features.execute(abilities.ptp_latch));
  PtpReading reading;
  EDGESPLAT_TRY(reading.status, features.chosen(abilities.ptp_status));
  if (abilities.ptp_offset.empty()) return reading;
  EDGESPLAT_TRY(reading.offset_ns, features.integer(abilities.ptp_offset));
  return reading;
}

Result<std::int64_t> read_clock_ticks(FeatureAccess& features, const CameraAbilities& abilities) {
  if (abilities.clock_latch.empty() || abilities.clock_value.empty())
    return fail(Errc::kNotFound, "the camera's clock cannot be read");
  EDGESPLAT_TRY_STATUS(features.execute(abilities.clock_latch));
  return features.integer(abilities.clock_value);
}

}  // namespace edgesplat::aravis
