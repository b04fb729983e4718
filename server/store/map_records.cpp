// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/map_records.hpp"

#include "common/base/bytes.hpp"
#include "common/map/delta_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace edgesplat::store {
namespace {

tl::unexpected<Error> refuse(const char* what) {
  return fail(Errc::kCorrupt, std::string("a map file's record makes no sense: ") + what);
}

void write_pose(ByteWriter& out, const geometry::RigidTransform& pose) {
  for (const double v : pose.translation_m) out.write(v);
  for (const double v : pose.rotation.coeffs()) out.write(v);
}

geometry::RigidTransform read_pose(ByteReader& in) {
  geometry::RigidTransform pose;
  for (double& v : pose.translation_m) v = in.read<double>();
  for (double& v : pose.rotation.coeffs()) v = in.read<double>();
  return pose;
}

/// The arrays of a cloud that hold floats, in the order of the file.
auto float_arrays(auto& cloud) {
  return std::array{&cloud.means_m, &cloud.log_scales, &cloud.quats_xyzw, &cloud.opacity_logits, &cloud.sh};
}

}  // namespace

std::vector<std::byte> encode_head(const Head& head) {
  ByteWriter out;
  out.write_bytes(head.map.bytes);
  out.write(head.robot.value);
  out.write(head.session);
  out.write(head.epoch.value);
  out.write(head.next_id_counter);
  out.write(head.gaussians);
  out.write(static_cast<std::uint8_t>(head.sh_degree));
  out.write(static_cast<std::uint8_t>(head.full_precision ? 1 : 0));
  return out.take();
}

Result<Head> decode_head(std::span<const std::byte> payload) {
  ByteReader in(payload);
  Head head;
  const auto uuid = in.take(head.map.bytes.size());
  std::copy(uuid.begin(), uuid.end(), head.map.bytes.begin());
  head.robot.value = in.read<std::uint16_t>();
  head.session = in.read<std::uint64_t>();
  head.epoch.value = in.read<std::uint32_t>();
  head.next_id_counter = in.read<std::uint64_t>();
  head.gaussians = in.read<std::uint64_t>();
  head.sh_degree = in.read<std::uint8_t>();
  head.full_precision = in.read<std::uint8_t>() != 0;
  if (!in.ok() || in.remaining() != 0 || head.sh_degree > 3) return refuse("its head");
  return head;
}

std::vector<std::byte> encode_poses(std::span<const StoredPose> poses) {
  ByteWriter out;
  for (const StoredPose& pose : poses) {
    out.write(pose.keyframe);
    out.write(pose.version);
    write_pose(out, pose.map_from_body);
  }
  return out.take();
}

Result<std::vector<StoredPose>> decode_poses(std::span<const std::byte> payload) {
  constexpr std::size_t kPose_bytes = 8 + 7 * 8;
  if (payload.size() % kPose_bytes != 0) return refuse("the number of poses");
  ByteReader in(payload);
  std::vector<StoredPose> poses(payload.size() / kPose_bytes);
  for (StoredPose& pose : poses) {
    pose.keyframe = in.read<std::uint32_t>();
    pose.version = in.read<std::uint32_t>();
    pose.map_from_body = read_pose(in);
    const double norm2 = pose.map_from_body.rotation.coeffs().squaredNorm();
    if (!pose.map_from_body.is_finite() || !(std::abs(norm2 - 1.0) < 1e-2)) return refuse("a pose");
  }
  return poses;
}

std::vector<std::byte> encode_chunk(std::uint64_t first, const map::QuantisedRows& rows) {
  ByteWriter out;
  out.write(first);
  out.write(static_cast<std::uint32_t>(rows.size()));
  out.write(static_cast<std::uint8_t>(rows.sh_degree));
  const map::ChunkId chunk = rows.chunks.front();
  out.write(chunk.x);
  out.write(chunk.y);
  out.write(chunk.z);
  map::AttributeWriter attributes(out);
  map::write_whole_rows(attributes, rows);
  return out.take();
}

Result<std::pair<std::uint64_t, map::QuantisedRows>> decode_chunk(std::span<const std::byte> payload) {
  ByteReader in(payload);
  const auto first = in.read<std::uint64_t>();
  const std::size_t count = in.read<std::uint32_t>();
  const int sh_degree = in.read<std::uint8_t>();
  map::ChunkId chunk;
  chunk.x = in.read<std::int32_t>();
  chunk.y = in.read<std::int32_t>();
  chunk.z = in.read<std::int32_t>();
  if (!in.ok() || count > kMaxChunkRows || sh_degree > 3 || !map::chunk_in_map(chunk))
    return refuse("a chunk's numbers");
  EDGESPLAT_TRY(auto rows, map::read_whole_rows(in, sh_degree, count));
  if (in.remaining() != 0) return refuse("a chunk's length");
  rows.chunks.assign(count, chunk);
  return std::pair(first, std::move(rows));
}

std::vector<std::byte> encode_floats(std::uint64_t first, const gaussian::GaussianCloud& cloud) {
  ByteWriter out;
  out.write(first);
  out.write(static_cast<std::uint32_t>(cloud.size()));
  out.write(static_cast<std::uint8_t>(cloud.sh_degree));
  for (const auto& id : cloud.ids) out.write(id.packed());
  for (const auto* values : float_arrays(cloud)) out.write_bytes(std::as_bytes(std::span(*values)));
  return out.take();
}

Result<std::pair<std::uint64_t, gaussian::GaussianCloud>> decode_floats(std::span<const std::byte> payload) {
  ByteReader in(payload);
  const auto first = in.read<std::uint64_t>();
  const std::size_t count = in.read<std::uint32_t>();
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = in.read<std::uint8_t>();
  if (!in.ok() || count > kMaxChunkRows || cloud.sh_degree > 3 ||
      in.remaining() != count * (8 + 4 * (11 + cloud.sh_floats_each())))
    return refuse("a chunk's floats");
  cloud.resize(count);
  for (auto& id : cloud.ids) id = gaussian::GaussianId::from_packed(in.read<std::uint64_t>());
  for (auto* values : float_arrays(cloud)) {
    const auto bytes = in.take(values->size() * sizeof(float));
    if (!bytes.empty()) std::memcpy(values->data(), bytes.data(), bytes.size());
  }
  for (std::size_t row = 0; row < count; ++row) {
    if (map::unquantisable(cloud, row) != nullptr) return refuse("a float");
  }
  return std::pair(first, std::move(cloud));
}

}  // namespace edgesplat::store
