// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/score.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/recording_topics.hpp"
#include "common/sensor/rig_config.hpp"
#include "kernels/image/undistort.hpp"
#include "tools/quality/held_out_scores.hpp"
#include "tools/quality/load_where_there.hpp"
#include "tools/quality/static_mask.hpp"
#include "tools/report/references.hpp"
#include "tools/simulate/simulate_options.hpp"
#include "tools/simulate/virtual_camera.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::desk {
namespace {

Result<std::unique_ptr<simulate::World>> world_of(const std::filesystem::path& recording) {
  EDGESPLAT_TRY(const io::McapReader reader, io::McapReader::open(recording));
  auto attachment = reader.attachment(io::kWorldAttachment);
  if (!attachment) {
    return fail(Errc::kNotFound, recording.string() + " was not simulated (" + attachment.error().context +
                                     "): there is no clean world to compare with. Without --input the map is "
                                     "compared with pictures that the robot held out of mapping");
  }
  const auto* text = reinterpret_cast<const char*>(attachment->content.data());
  EDGESPLAT_TRY(const simulate::SimulateOptions options,
                simulate::parse_world_toml({text, attachment->content.size()}));
  return simulate::World::create(options.world);
}

/// The robot's true poses at its own stamps.
Result<std::vector<accuracy::PosePair>> truth_of(report::RunFolder& run, const std::filesystem::path& input) {
  for (report::Reference& reference : report::find_references(run, input)) {
    if (reference.name == "truth") return std::move(reference.pairs);
  }
  return fail(Errc::kNotFound, "no true trajectory for " + run.folder.string() + ": " +
                                   (run.missing.empty() ? "give --input" : run.missing.back()));
}

/// What a run gives however it is scored: keyframes and maps.
Result<quality::HeldOutInput> maps_of(const std::filesystem::path& run) {
  quality::HeldOutInput input;
  EDGESPLAT_TRY(input.keyframes, quality::read_saved_keyframes(run / "robot" / "keyframes"));
  EDGESPLAT_TRY(input.map, io::read_gaussians_ply(run / "robot" / "gaussians_at_input_end.ply"));
  const auto seeded = run / "server" / "seeded.ply";
  if (std::filesystem::exists(seeded)) {
    EDGESPLAT_TRY(input.seeded, io::read_gaussians_ply(seeded));
  }
  return input;
}

Result<std::vector<quality::SavedKeyframe>> pictures_held_out(const std::filesystem::path& run) {
  auto pictures = quality::read_saved_keyframes(run / "robot" / "heldout");
  if (pictures || pictures.error().code != Errc::kNotFound) return pictures;
  return fail(Errc::kNotFound,
              "nothing to compare the map of " + run.string() +
                  " with: give the simulated recording with --input, or let the robot hold pictures out of "
                  "mapping (there are none in " +
                  (run / "robot" / "heldout").string() + ")");
}

/// The run's camera, as far as scoring goes.
struct ScoredCamera {
  geometry::RigidTransform body_from_camera;
  std::vector<float> seen;  ///< [H,W] pixels that the undistorted camera sees
};
Result<ScoredCamera> camera_of(const report::RunFolder& run) {
  EDGESPLAT_TRY(const sensor::Rig rig, sensor::parse_rig(run.rig_toml, "rig.toml"));
  if (!rig.camera) return fail(Errc::kNotFound, "the robot of this run has no camera");
  const image::Undistorter undistorter(rig.camera->model);
  return ScoredCamera{rig.camera->body_from_camera, {undistorter.seen().begin(), undistorter.seen().end()}};
}

Result<quality::HeldOutScores> score_against_world(const ScoreOptions& options, report::RunFolder& run,
                                                   quality::Lpips* lpips) {
  EDGESPLAT_TRY(const std::unique_ptr<simulate::World> world, world_of(options.input));
  EDGESPLAT_TRY(const auto truth, truth_of(run, options.input));
  EDGESPLAT_TRY(const ScoredCamera camera, camera_of(run));
  EDGESPLAT_TRY(quality::HeldOutInput input, maps_of(options.run));
  for (auto& keyframe : input.keyframes) keyframe.stamp -= report::host_minus_recording(run);
  EDGESPLAT_TRY(input.views, quality::choose_held_out_views(input.keyframes, truth, camera.body_from_camera,
                                                            options.views));
  input.kind = quality::HeldOutKind::kSimulated;
  input.lpips = lpips;
  input.truth = [&](const quality::HeldOutView& view) -> Result<quality::HeldOutTruth> {
    return quality::HeldOutTruth{
        simulate::clean_picture(*world, input.keyframes.front().camera, view.world_from_camera),
        camera.seen,
        {}};
  };
  return quality::score_held_out(input, options.run / "heldout");
}

/// Fewer pixels, as a share of the picture, say too little.
constexpr double kLeastShare = 0.01;

/// `mask` may be null: then every pixel counts that the camera saw.
Result<quality::HeldOutTruth> truth_of_picture(const std::filesystem::path& path, const ScoredCamera& camera,
                                               quality::StaticMask* mask) {
  quality::HeldOutTruth truth{{}, camera.seen, {}};
  EDGESPLAT_TRY(truth.picture, io::load_rgb8(path));
  if (truth.picture.values.size() != 3 * truth.weight.size()) {
    return fail(Errc::kCorrupt, path.string() + " does not have the size of the camera in rig.toml");
  }
  if (mask == nullptr) return truth;
  EDGESPLAT_TRY(const quality::StaticWeights stays, mask->weights(truth.picture));
  truth.weight_with_shadows = camera.seen;
  for (std::size_t i = 0; i < camera.seen.size(); ++i) {
    truth.weight[i] *= stays.without_shadows[i];
    truth.weight_with_shadows[i] *= stays.without_movers[i];
  }
  // Where movers fill the picture nothing may be left.
  if (quality::share_that_counts(truth.weight) < kLeastShare) truth.weight = truth.weight_with_shadows;
  return truth;
}

Result<quality::HeldOutScores> score_against_pictures(const ScoreOptions& options,
                                                      const report::RunFolder& run, quality::Lpips* lpips) {
  EDGESPLAT_TRY(const auto held_out, pictures_held_out(options.run));
  EDGESPLAT_TRY(const ScoredCamera camera, camera_of(run));
  EDGESPLAT_TRY(auto mask, quality::load_where_there<quality::StaticMask>(options.mask_model));
  EDGESPLAT_TRY(quality::HeldOutInput input, maps_of(options.run));
  EDGESPLAT_TRY(input.views, quality::views_of_pictures(input.keyframes, held_out, options.views));
  input.kind = quality::HeldOutKind::kReal;
  input.movers_masked = mask.has_value();
  input.lpips = lpips;
  input.truth = [&](const quality::HeldOutView& view) {
    return truth_of_picture(view.picture, camera, mask ? &*mask : nullptr);
  };
  return quality::score_held_out(input, options.run / "heldout");
}

}  // namespace

Result<nlohmann::json> score_run(const ScoreOptions& options) {
  EDGESPLAT_TRY(report::RunFolder run, report::read_run_folder(options.run));
  EDGESPLAT_TRY(auto network, quality::load_where_there<quality::Lpips>(options.lpips_model));
  quality::Lpips* lpips = network ? &*network : nullptr;
  EDGESPLAT_TRY(const quality::HeldOutScores scores, options.input.empty()
                                                         ? score_against_pictures(options, run, lpips)
                                                         : score_against_world(options, run, lpips));
  nlohmann::json json = quality::to_json(scores);
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(options.run / "heldout.json", json.dump(1) + "\n"));
  return json;
}

}  // namespace edgesplat::desk
