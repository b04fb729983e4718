// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_features.hpp"

#include "tools/virtual_device/gige_gvsp.hpp"

#include <cstdio>

namespace edgesplat::virtual_device {
namespace {

namespace reg = gige_register;
using Entries = std::vector<std::pair<std::string_view, std::uint32_t>>;

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof(text), "0x%X", value);
  return text;
}

std::string tag(std::string_view name, std::string_view content) {
  std::string out = "<";
  out.append(name).append(">").append(content).append("</").append(name).append(">");
  return out;
}

/// Writes the nodes of a description. A register is read anew at each access: the camera may change it.
class Description {
 public:
  void integer(std::string_view name, std::uint32_t address, bool writable, std::int64_t min,
               std::int64_t max) {
    reg_node("IntReg", name, address, 4, writable, "Device");
    open("Integer", name);
    text_ +=
        tag("pValue", reg_name(name)) + tag("Min", std::to_string(min)) + tag("Max", std::to_string(max));
    close("Integer");
  }
  /// A bare register, e.g. of 8 bytes or in a chunk.
  void register_integer(std::string_view name, std::uint32_t address, std::uint32_t bytes,
                        std::string_view port, bool is_signed = false) {
    features_ += tag("pFeature", name);
    open("IntReg", name);
    register_body(address, bytes, false, port, is_signed ? "Signed" : "Unsigned");
    close("IntReg");
  }
  void register_float(std::string_view name, std::uint32_t address, std::uint32_t bytes,
                      std::string_view port) {
    features_ += tag("pFeature", name);
    open("FloatReg", name);
    register_body(address, bytes, false, port, "");
    close("FloatReg");
  }
  void number(std::string_view name, std::uint32_t address, double min, double max) {
    reg_node("FloatReg", name, address, 4, true, "Device");
    open("Float", name);
    text_ +=
        tag("pValue", reg_name(name)) + tag("Min", std::to_string(min)) + tag("Max", std::to_string(max));
    close("Float");
  }
  void boolean(std::string_view name, std::uint32_t address, std::string_view index = "") {
    reg_node("IntReg", name, address, 4, true, "Device", index);
    open("Boolean", name);
    text_ += tag("pValue", reg_name(name)) + tag("OnValue", "1") + tag("OffValue", "0");
    close("Boolean");
  }
  void command(std::string_view name, std::uint32_t address) {
    reg_node("IntReg", name, address, 4, true, "Device");
    open("Command", name);
    text_ += tag("pValue", reg_name(name)) + tag("CommandValue", "1");
    close("Command");
  }
  void choice(std::string_view name, std::uint32_t address, const Entries& entries, bool writable = true,
              std::string_view index = "") {
    reg_node("IntReg", name, address, 4, writable, "Device", index);
    open_choice(name, entries);
    text_ += tag("pValue", reg_name(name));
    close("Enumeration");
  }
  /// A choice that only this program's memory of the camera knows; INDEX is what others name as pIndex.
  void selector(std::string_view name, const Entries& entries) {
    features_ += tag("pFeature", name);
    open("Integer", index_name(name));
    text_ += tag("Value", "0");
    close("Integer");
    open_choice(name, entries);
    text_ += tag("pValue", index_name(name));
    close("Enumeration");
  }
  void port(std::string_view name, std::uint32_t chunk = 0) {
    open("Port", name);
    if (chunk != 0) {
      text_ += tag("ChunkID", hex(chunk).substr(2));
    }
    close("Port");
  }
  /// GevSCPSPacketSize and GevSCPSFireTestPacket: parts of one bootstrap register. Bit 0 is the highest.
  void packet_size(std::uint32_t min, std::uint32_t max) {
    const auto part = [this](std::string_view name, const std::string& bits) {
      features_ += tag("pFeature", name);
      open("MaskedIntReg", reg_name(name));
      register_body(0xD04, 4, true, "Device", "");
      text_ += bits;
      close("MaskedIntReg");
    };
    part("GevSCPSPacketSize", tag("LSB", "31") + tag("MSB", "16") + tag("Sign", "Unsigned"));
    open("Integer", "GevSCPSPacketSize");
    text_ += tag("pValue", reg_name("GevSCPSPacketSize")) + tag("Min", std::to_string(min)) +
             tag("Max", std::to_string(max)) + tag("Inc", "4");
    close("Integer");
    part("GevSCPSFireTestPacket", tag("Bit", "0"));
    open("Command", "GevSCPSFireTestPacket");
    text_ += tag("pValue", reg_name("GevSCPSFireTestPacket")) + tag("CommandValue", "1");
    close("Command");
  }
  [[nodiscard]] std::string finish() const {
    std::string out = R"(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="VirtualCamera" VendorName="edgesplat" ToolTip="A recording as a camera"
 StandardNameSpace="None" SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0"
 MajorVersion="1" MinorVersion="0" SubMinorVersion="0" ProductGuid="6f9d3a5e-64c0-4e19-8f3e-0d1b6f0a7c11"
 VersionGuid="6f9d3a5e-64c0-4e19-8f3e-0d1b6f0a7c12" xmlns="http://www.genicam.org/GenApi/Version_1_1"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xsi:schemaLocation="http://www.genicam.org/GenApi/Version_1_1 GenApiSchema_Version_1_1.xsd">
)";
    out += "<Category Name=\"Root\">" + tag("pFeature", "Features") + "</Category>\n";
    out += "<Category Name=\"Features\">" + features_ + "</Category>\n" + text_ + "</RegisterDescription>\n";
    return out;
  }

 private:
  static std::string reg_name(std::string_view name) { return std::string(name) + "Reg"; }
  static std::string index_name(std::string_view name) { return std::string(name) + "Index"; }
  void open(std::string_view kind, std::string_view name) {
    text_.append("<").append(kind).append(" Name=\"").append(name).append("\">");
  }
  void close(std::string_view kind) { text_.append("</").append(kind).append(">\n"); }
  void open_choice(std::string_view name, const Entries& entries) {
    open("Enumeration", name);
    for (const auto& [entry, value] : entries) {
      text_.append("<EnumEntry Name=\"").append(entry).append("\">");
      text_ += tag("Value", std::to_string(value)) + "</EnumEntry>";
    }
  }
  void register_body(std::uint32_t address, std::uint32_t bytes, bool writable, std::string_view port,
                     std::string_view sign, std::string_view index = "") {
    text_ += tag("Address", hex(address));
    if (!index.empty())
      text_.append("<pIndex Offset=\"").append(index_step(index)).append("\">") +=
          index_name(index) + "</pIndex>";
    text_ += tag("Length", std::to_string(bytes)) + tag("AccessMode", writable ? "RW" : "RO") +
             tag("pPort", port) + tag("Cachable", "NoCache");
    if (!sign.empty()) text_ += tag("Sign", sign);
    text_ += tag("Endianess", "BigEndian");
  }
  static std::string_view index_step(std::string_view index) {
    return index == "ChunkSelector" ? "0x4" : "0x20";
  }
  void reg_node(std::string_view kind, std::string_view name, std::uint32_t address, std::uint32_t bytes,
                bool writable, std::string_view port, std::string_view index = "") {
    features_ += tag("pFeature", name);
    open(kind, reg_name(name));
    register_body(address, bytes, writable, port, kind == "IntReg" ? "Unsigned" : "", index);
    close(kind);
  }

  std::string features_;
  std::string text_;
};

void describe_format(Description& d, std::uint32_t width_px, std::uint32_t height_px) {
  d.integer("SensorWidth", reg::kWidth, false, width_px, width_px);
  d.integer("SensorHeight", reg::kHeight, false, height_px, height_px);
  d.integer("Width", reg::kWidth, false, width_px, width_px);
  d.integer("Height", reg::kHeight, false, height_px, height_px);
  d.choice("PixelFormat", reg::kPixelFormat,
           {{"Mono8", static_cast<std::uint32_t>(GigePixelFormat::kMono8)},
            {"BayerRG8", static_cast<std::uint32_t>(GigePixelFormat::kBayerRg8)},
            {"RGB8", static_cast<std::uint32_t>(GigePixelFormat::kRgb8)}});
  d.register_integer("PayloadSize", reg::kPayloadBytes, 4, "Device");
}

void describe_acquisition(Description& d, bool older) {
  d.command("AcquisitionStart", reg::kAcquisitionStart);
  d.command("AcquisitionStop", reg::kAcquisitionStop);
  d.choice("AcquisitionMode", reg::kAcquisitionMode, {{"Continuous", 0}});
  d.boolean("AcquisitionFrameRateEnable", reg::kFrameRateEnable);
  d.number(older ? "AcquisitionFrameRateAbs" : "AcquisitionFrameRate", reg::kFrameRate, 0.1, 200.0);
  d.selector("TriggerSelector", {{"FrameStart", 0}, {"AcquisitionStart", 1}});
  d.choice("TriggerMode", reg::kTriggerMode, {{"Off", 0}, {"On", 1}}, true, "TriggerSelector");
  d.choice("TriggerSource", reg::kTriggerSource, {{"Line0", 0}, {"Software", 1}}, true, "TriggerSelector");
  d.choice("TriggerActivation", reg::kTriggerActivation, {{"RisingEdge", 0}, {"FallingEdge", 1}}, true,
           "TriggerSelector");
  d.number(older ? "TriggerDelayAbs" : "TriggerDelay", reg::kTriggerDelay, 0.0, 1e6);
  d.command("TriggerSoftware", reg::kTriggerSoftware);
}

void describe_exposure(Description& d, bool older) {
  d.number(older ? "ExposureTimeAbs" : "ExposureTime", reg::kExposureTime, 10.0, 1e6);
  d.choice("ExposureAuto", reg::kExposureAuto, {{"Off", 0}, {"Continuous", 1}});
  if (older) {
    d.integer("GainRaw", reg::kGain, true, 0, 240);
  } else {
    d.number("Gain", reg::kGain, 0.0, 24.0);
  }
  d.choice("GainAuto", reg::kGainAuto, {{"Off", 0}, {"Continuous", 1}});
}

void describe_chunks(Description& d) {
  d.boolean("ChunkModeActive", reg::kChunkModeActive);
  d.selector("ChunkSelector",
             {{"Timestamp", 0}, {"ExposureTime", 1}, {"Gain", 2}, {"FrameID", 3}, {"CounterValue", 4}});
  d.boolean("ChunkEnable", reg::kChunkEnable, "ChunkSelector");
  d.register_integer("ChunkTimestamp", 0, 8, "ChunkTimestampPort");
  d.register_float("ChunkExposureTime", 0, 8, "ChunkExposureTimePort");
  d.register_float("ChunkGain", 0, 8, "ChunkGainPort");
  d.register_integer("ChunkFrameID", 0, 8, "ChunkFrameIDPort");
  d.register_integer("ChunkCounterValue", 0, 8, "ChunkCounterValuePort");
  d.port("ChunkTimestampPort", chunk_id(GigeChunk::kTimestamp));
  d.port("ChunkExposureTimePort", chunk_id(GigeChunk::kExposureTime));
  d.port("ChunkGainPort", chunk_id(GigeChunk::kGain));
  d.port("ChunkFrameIDPort", chunk_id(GigeChunk::kFrameId));
  d.port("ChunkCounterValuePort", chunk_id(GigeChunk::kCounterValue));
}

void describe_ptp(Description& d, bool older) {
  const auto state = [](GigePtpState s) { return static_cast<std::uint32_t>(s); };
  d.boolean(older ? "GevIEEE1588" : "PtpEnable", reg::kPtpEnable);
  d.command(older ? "GevIEEE1588DataSetLatch" : "PtpDataSetLatch", reg::kPtpDataSetLatch);
  d.choice(older ? "GevIEEE1588StatusLatched" : "PtpStatus", reg::kPtpStatus,
           {{"Initializing", state(GigePtpState::kInitialising)},
            {"Disabled", state(GigePtpState::kDisabled)},
            {"Listening", state(GigePtpState::kListening)},
            {"Uncalibrated", state(GigePtpState::kUncalibrated)},
            {"Slave", state(GigePtpState::kSlave)}},
           false);
  d.register_integer(older ? "GevIEEE1588OffsetFromMaster" : "PtpOffsetFromMaster", reg::kPtpOffset, 8,
                     "Device", true);
}

void describe_transport(Description& d, bool older) {
  d.command(older ? "GevTimestampControlLatch" : "TimestampLatch", reg::kTimestampLatch);
  d.register_integer(older ? "GevTimestampValue" : "TimestampLatchValue", reg::kTimestampLatchValue, 8,
                     "Device");
  d.packet_size(kMinPacketBytes, kMaxPacketBytes);
}

}  // namespace

std::string gige_description(GigeVocabulary vocabulary, std::uint32_t sensor_width_px,
                             std::uint32_t sensor_height_px) {
  const bool older = vocabulary == GigeVocabulary::kOlder;
  Description d;
  describe_format(d, sensor_width_px, sensor_height_px);
  describe_acquisition(d, older);
  describe_exposure(d, older);
  if (vocabulary != GigeVocabulary::kWithoutPtp) {
    describe_chunks(d);
    describe_ptp(d, older);
  }
  describe_transport(d, older);
  d.port("Device");
  std::string text = d.finish();
  while (text.size() % 4 != 0) text.push_back('\n');  // hosts read in whole words
  return text;
}

}  // namespace edgesplat::virtual_device
