// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/accuracy/evaluation.hpp"
#include "tools/report/run_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::report {

/// What the run's trajectory is judged against.
struct Reference {
  std::string name;  ///< "truth", "poses_kiss_icp_pseudo"
  std::vector<accuracy::PosePair> pairs;
  accuracy::Evaluation evaluation;
};

/// How far a live run's stamps are ahead of the recording that was streamed; 0 for a replay.
[[nodiscard]] nanoseconds host_minus_recording(const RunFolder& run);

/// Every reference of the run: truth.tum of the folder, else the truth in the recording `input` (written to
/// truth.tum), else the poses_*_pseudo.txt of the folder `input`. `input` may be empty. What cannot be used
/// is said in run.missing. A live run's stamps are brought to the recording's time by what the stream said
/// (host_minus_recording_s).
[[nodiscard]] std::vector<Reference> find_references(RunFolder& run, const std::filesystem::path& input);

}  // namespace edgesplat::report
