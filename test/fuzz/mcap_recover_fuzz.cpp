// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/base/unique_fd.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/mcap_recover.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

/// A file that is anything, recovered in place: what was readable before is readable after, by the summary.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  const UniqueFd fd(::memfd_create("cut.mcap", MFD_CLOEXEC));
  if (::write(fd.get(), bytes, size) != static_cast<ssize_t>(size)) return 0;
  const std::string path = "/proc/self/fd/" + std::to_string(fd.get());
  const auto recovery = io::recover_mcap(path);
  if (!recovery || recovery->was_whole) return 0;
  auto reader = io::McapReader::open(path);
  EDGESPLAT_CHECK(reader.has_value(), "a recovered file can be opened");
  EDGESPLAT_CHECK(reader->report().used_summary, "a recovered file has its end");
  EDGESPLAT_CHECK(reader->statistics().message_count == recovery->statistics.message_count,
                  "a recovered file has as many messages as recovery said");
  while (reader->next()) {
  }
  return 0;
}
