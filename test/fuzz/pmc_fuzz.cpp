// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/ptp_monitor.hpp"

#include <cstdint>
#include <string_view>

/// The text of pmc, and what is judged of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat::sync;
  PtpJudgement judgement;
  (void)judgement.on_report(parse_pmc({reinterpret_cast<const char*>(bytes), size}));
  return 0;
}
