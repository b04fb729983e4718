// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/score.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/recording_topics.hpp"
#include "common/sensor/rig_config.hpp"
#include "kernels/image/undistort.hpp"
#include "tools/quality/held_out_scores.hpp"
#include "tools/report/references.hpp"
#include "tools/simulate/simulate_options.hpp"
#include "tools/simulate/virtual_camera.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <utility>

namespace edgesplat::desk {
namespace {

Result<std::unique_ptr<simulate::World>> world_of(const std::filesystem::path& recording) {
  EDGESPLAT_TRY(const io::McapReader reader, io::McapReader::open(recording));
  auto attachment = reader.attachment(io::kWorldAttachment);
  if (!attachment) {
    return fail(Errc::kNotFound, recording.string() + " was not simulated (" + attachment.error().context +
                                     "): there is no clean world to compare with");
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

}  // namespace

Result<nlohmann::json> score_run(const ScoreOptions& options) {
  EDGESPLAT_TRY(const std::unique_ptr<simulate::World> world, world_of(options.input));
  EDGESPLAT_TRY(report::RunFolder run, report::read_run_folder(options.run));
  EDGESPLAT_TRY(const auto truth, truth_of(run, options.input));
  EDGESPLAT_TRY(const sensor::Rig rig, sensor::parse_rig(run.rig_toml, "rig.toml"));
  if (!rig.camera) return fail(Errc::kNotFound, "the robot of this run has no camera");

  quality::HeldOutInput input;
  EDGESPLAT_TRY(input.keyframes, quality::read_saved_keyframes(options.run / "robot" / "keyframes"));
  for (auto& keyframe : input.keyframes) keyframe.stamp -= report::host_minus_recording(run);
  EDGESPLAT_TRY(input.views, quality::choose_held_out_views(input.keyframes, truth,
                                                            rig.camera->body_from_camera, options.views));
  EDGESPLAT_TRY(input.map, io::read_gaussians_ply(options.run / "robot" / "gaussians_at_input_end.ply"));
  const auto seeded = options.run / "server" / "seeded.ply";
  if (std::filesystem::exists(seeded)) {
    EDGESPLAT_TRY(input.seeded, io::read_gaussians_ply(seeded));
  }
  const image::Undistorter undistorter(rig.camera->model);
  input.seen.assign(undistorter.seen().begin(), undistorter.seen().end());
  input.target = [&](const quality::HeldOutView& view) -> Result<sensor::ImageRgb8> {
    return simulate::clean_picture(*world, input.keyframes.front().camera, view.world_from_camera);
  };
  std::optional<quality::Lpips> lpips;
  if (!options.lpips_model.empty() && std::filesystem::exists(options.lpips_model)) {
    EDGESPLAT_TRY(auto network, quality::Lpips::load(options.lpips_model));
    lpips = std::move(network);
    input.lpips = &*lpips;
  }
  EDGESPLAT_TRY(const auto scores, quality::score_held_out(input, options.run / "heldout"));
  nlohmann::json json = quality::to_json(scores);
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(options.run / "heldout.json", json.dump(1) + "\n"));
  return json;
}

}  // namespace edgesplat::desk
