// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/association.hpp"

#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"

#include <algorithm>

namespace edgesplat::accuracy {
namespace {

std::vector<io::StampedPose> sorted(std::span<const io::StampedPose> poses) {
  std::vector<io::StampedPose> copy(poses.begin(), poses.end());
  std::stable_sort(copy.begin(), copy.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return copy;
}

/// `poses` is sorted and not empty.
const io::StampedPose& nearest(const std::vector<io::StampedPose>& poses, HostTime stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const io::StampedPose& pose, HostTime t) { return pose.stamp < t; });
  if (after == poses.begin()) return *after;
  const auto before = std::prev(after);
  if (after == poses.end() || stamp - before->stamp <= after->stamp - stamp) return *before;
  return *after;
}

}  // namespace

std::vector<PosePair> associate(std::span<const io::StampedPose> estimate,
                                std::span<const io::StampedPose> reference, nanoseconds max_diff) {
  std::vector<PosePair> pairs;
  if (estimate.empty() || reference.empty()) return pairs;
  const bool estimate_is_longer = estimate.size() > reference.size();
  const auto shorter = sorted(estimate_is_longer ? reference : estimate);
  const auto longer = sorted(estimate_is_longer ? estimate : reference);
  for (const io::StampedPose& pose : shorter) {
    const io::StampedPose& other = nearest(longer, pose.stamp);
    if (std::chrono::abs(other.stamp - pose.stamp) > max_diff) continue;
    const io::StampedPose& estimated = estimate_is_longer ? other : pose;
    const io::StampedPose& truth = estimate_is_longer ? pose : other;
    pairs.push_back({estimated.stamp, estimated.world_from_body, truth.world_from_body});
  }
  return pairs;
}

std::vector<PosePair> associate_interpolated(std::span<const io::StampedPose> estimate,
                                             std::span<const io::StampedPose> reference,
                                             nanoseconds max_gap) {
  std::vector<PosePair> pairs;
  const auto truth = sorted(reference);
  for (const io::StampedPose& pose : sorted(estimate)) {
    const auto after = std::lower_bound(truth.begin(), truth.end(), pose.stamp,
                                        [](const io::StampedPose& one, HostTime t) { return one.stamp < t; });
    if (after == truth.end()) continue;
    if (after->stamp == pose.stamp) {
      pairs.push_back({pose.stamp, pose.world_from_body, after->world_from_body});
      continue;
    }
    if (after == truth.begin() || after->stamp - std::prev(after)->stamp > max_gap) continue;
    const io::StampedPose& before = *std::prev(after);
    const double share = to_seconds(pose.stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
    const geometry::RigidTransform& a = before.world_from_body;
    const geometry::RigidTransform& b = after->world_from_body;
    pairs.push_back({pose.stamp,
                     pose.world_from_body,
                     {a.rotation.slerp(share, b.rotation),
                      a.translation_m + share * (b.translation_m - a.translation_m)}});
  }
  return pairs;
}

Result<std::vector<io::StampedPose>> read_recorded_truth(const std::filesystem::path& recording) {
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(recording));
  io::McapSelection selection;
  selection.topics.emplace_back(io::kTruthBodyPoseTopic);
  reader.select(std::move(selection));
  std::vector<io::StampedPose> poses;
  while (const auto message = reader.next()) {
    EDGESPLAT_TRY(const io::PoseStamped pose, io::decode_pose_stamped(message->payload));
    poses.push_back({pose.stamp, pose.frame_from_body});
  }
  if (poses.empty()) {
    return fail(Errc::kNotFound,
                recording.string() + " has no truth on " + std::string(io::kTruthBodyPoseTopic));
  }
  return poses;
}

/// First poses later than this after time 0 are not a replayed folder's.
constexpr nanoseconds kFolderStart = std::chrono::seconds(1);

Result<std::vector<io::StampedPose>> read_reference(const ReferenceSource& source, HostTime start) {
  if (source.format == ReferenceFormat::kTum) return io::read_tum(source.path);
  EDGESPLAT_TRY(const auto poses, io::read_kitti(source.path));
  std::vector<HostTime> stamps;
  if (source.times) {
    EDGESPLAT_TRY(stamps, io::read_times(*source.times));
    if (stamps.size() != poses.size()) {
      return fail(Errc::kInvalidArgument, source.times->string() + " has " + std::to_string(stamps.size()) +
                                              " stamps for the " + std::to_string(poses.size()) +
                                              " poses of " + source.path.string());
    }
  } else {
    // A folder is replayed from time 0, and its first poses may be missing; stamps of a clock share only the
    // start.
    if (start >= HostTime{} && start < HostTime{} + kFolderStart) start = HostTime{};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      stamps.push_back(start + from_seconds(static_cast<double>(i) / source.rate_hz));
    }
  }
  std::vector<io::StampedPose> stamped;
  stamped.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) stamped.push_back({stamps[i], poses[i]});
  return stamped;
}

}  // namespace edgesplat::accuracy
