// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"
#include "common/sensor/rig_config.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

/// Any text as a rig.toml; the part after a NUL as a --set on top.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(bytes), size);
  const std::size_t cut = all.find('\0');
  auto file = edgesplat::config::ConfigFile::parse(all.substr(0, cut), "fuzz.toml");
  if (!file) return 0;
  if (cut != std::string_view::npos) (void)file->apply_override(all.substr(cut + 1));
  edgesplat::sensor::Rig rig;
  if (!file->read_into(rig)) return 0;
  // What was accepted must survive printing and reading again.
  if (!edgesplat::sensor::parse_rig(edgesplat::sensor::print_rig(rig), "printed")) __builtin_trap();
  return 0;
}
