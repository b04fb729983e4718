// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/references.hpp"

#include <algorithm>

namespace edgesplat::report {
namespace {

constexpr auto kMaxDiff = from_seconds(0.01);
constexpr auto kMaxDiffOfScans = from_seconds(0.05);  // references without stamps: half a 10 Hz scan

std::vector<std::filesystem::path> pseudo_poses(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with("poses_") && name.ends_with("_pseudo.txt")) paths.push_back(it->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<io::StampedPose> in_recording_time(const RunFolder& run) {
  std::vector<io::StampedPose> trajectory = run.trajectory;
  const nanoseconds ahead = host_minus_recording(run);
  for (io::StampedPose& pose : trajectory) pose.stamp -= ahead;
  return trajectory;
}

class Collector {
 public:
  Collector(RunFolder& run, std::vector<Reference>& references)
      : run_(run), references_(references), trajectory_(in_recording_time(run)) {}

  void add(const std::string& name, const Result<std::vector<io::StampedPose>>& poses, nanoseconds max_diff) {
    if (!poses) {
      run_.missing.push_back(poses.error().context);
      return;
    }
    Reference reference{name, accuracy::associate(trajectory_, *poses, max_diff), {}};
    auto evaluation = accuracy::evaluate(reference.pairs);
    if (!evaluation) {
      run_.missing.push_back("cannot compare with " + name + ": " + evaluation.error().context);
      return;
    }
    reference.evaluation = *evaluation;
    references_.push_back(std::move(reference));
  }
  [[nodiscard]] HostTime start() const {
    return trajectory_.empty() ? HostTime{} : trajectory_.front().stamp;
  }

 private:
  RunFolder& run_;
  std::vector<Reference>& references_;
  std::vector<io::StampedPose> trajectory_;
};

}  // namespace

nanoseconds host_minus_recording(const RunFolder& run) {
  if (!run.stream.is_object() || !run.stream.contains("host_minus_recording_s")) return nanoseconds(0);
  const auto& offset = run.stream["host_minus_recording_s"];
  return offset.is_number() ? from_seconds(offset.get<double>()) : nanoseconds(0);
}

std::vector<Reference> find_references(RunFolder& run, const std::filesystem::path& input) {
  std::vector<Reference> references;
  Collector collector(run, references);
  const auto truth = run.folder / "truth.tum";
  std::error_code error;
  if (std::filesystem::exists(truth, error)) {
    collector.add("truth", io::read_tum(truth), kMaxDiff);
  } else if (input.extension() == ".mcap") {
    const auto poses = accuracy::read_recorded_truth(input);
    if (poses) {
      if (const Status written = io::write_tum(truth, *poses); !written) {
        run.missing.push_back(written.error().context);
      }
    }
    collector.add("truth", poses, kMaxDiff);
  } else if (!input.empty()) {
    for (const auto& path : pseudo_poses(input)) {
      const accuracy::ReferenceSource source{path, accuracy::ReferenceFormat::kKitti, std::nullopt, 10.0};
      collector.add(path.stem().string(), accuracy::read_reference(source, collector.start()),
                    kMaxDiffOfScans);
    }
  }
  if (references.empty())
    run.missing.push_back("no reference trajectory: the accuracy of this run is not known");
  return references;
}

}  // namespace edgesplat::report
