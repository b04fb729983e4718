// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/parallel_for.hpp"
#include "tools/desk/scene_start.hpp"

#include <Eigen/Dense>
#include <opencv2/features2d.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace edgesplat::desk {
namespace {

constexpr int kFeaturesAPicture = 6000;
constexpr std::size_t kPartners = 8;        // pictures that each picture is matched with
constexpr double kMaxViewAngle_rad = 0.9;   // between the looking directions of partners
constexpr double kMinRayAngle_rad = 0.026;  // 1.5 degrees
constexpr double kMaxReprojection_px = 1.5;
constexpr float kMatchRatio = 0.8F;  // best over second best distance (Lowe 2004)

struct Features {
  std::vector<Eigen::Vector2d> pixels;
  std::vector<std::array<std::uint8_t, 3>> rgb;
  cv::Mat descriptors;
};

Features find_features(const ScenePicture& picture) {
  const cv::Mat rgb(picture.picture.height_px, picture.picture.width_px, CV_8UC3,
                    const_cast<std::uint8_t*>(picture.picture.values.data()));
  cv::Mat green;
  cv::extractChannel(rgb, green, 1);
  std::vector<cv::KeyPoint> points;
  Features out;
  cv::SIFT::create(kFeaturesAPicture, 3, 0.02)
      ->detectAndCompute(green, cv::noArray(), points, out.descriptors);
  for (const cv::KeyPoint& point : points) {
    out.pixels.emplace_back(static_cast<double>(point.pt.x), static_cast<double>(point.pt.y));
    const int x = std::clamp(static_cast<int>(std::lround(point.pt.x)), 0, picture.picture.width_px - 1);
    const int y = std::clamp(static_cast<int>(std::lround(point.pt.y)), 0, picture.picture.height_px - 1);
    const std::uint8_t* colour = picture.picture.pixel(x, y);
    out.rgb.push_back({colour[0], colour[1], colour[2]});
  }
  return out;
}

Eigen::Vector3d looking_direction(const ScenePicture& picture) {
  return picture.map_from_camera.rotation * Eigen::Vector3d::UnitZ();
}

/// Pairs of pictures that look the same way, each picture with its nearest ones.
std::vector<std::pair<std::size_t, std::size_t>> partner_pairs(
    std::span<const ScenePicture* const> pictures) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t j = 0; j < pictures.size(); ++j) {
      const double cosine = looking_direction(*pictures[i]).dot(looking_direction(*pictures[j]));
      if (j == i || cosine < std::cos(kMaxViewAngle_rad)) continue;
      const auto apart =
          pictures[i]->map_from_camera.translation_m - pictures[j]->map_from_camera.translation_m;
      near.emplace_back(apart.norm(), j);
    }
    std::ranges::sort(near);
    // Every other one of the nearest, for a wider base.
    for (std::size_t k = 0; k < std::min(near.size(), 2 * kPartners); k += 2) {
      pairs.emplace_back(std::min(i, near[k].second), std::max(i, near[k].second));
    }
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

struct Ray {
  Eigen::Vector3d origin, direction;
};
Ray ray_through(const ScenePicture& picture, const Eigen::Vector2d& pixel) {
  return {picture.map_from_camera.translation_m,
          picture.map_from_camera.rotation * picture.camera.unproject(pixel)};
}

double reprojection_px(const ScenePicture& picture, const Eigen::Vector3d& p_in_map,
                       const Eigen::Vector2d& pixel) {
  const auto seen = picture.camera.project(picture.map_from_camera.inverse() * p_in_map);
  return seen ? (*seen - pixel).norm() : std::numeric_limits<double>::infinity();
}

/// The middle of the shortest line between two rays, if they meet in front of both cameras.
std::optional<Eigen::Vector3d> meeting_point(const Ray& a, const Ray& b) {
  const double cosine = a.direction.dot(b.direction);
  if (cosine > std::cos(kMinRayAngle_rad)) return std::nullopt;
  const Eigen::Vector3d base = b.origin - a.origin;
  const double denominator = 1.0 - cosine * cosine;
  const double along_a = (base.dot(a.direction) - cosine * base.dot(b.direction)) / denominator;
  const double along_b = (cosine * base.dot(a.direction) - base.dot(b.direction)) / denominator;
  if (along_a <= 0.0 || along_b <= 0.0) return std::nullopt;
  return 0.5 * (a.origin + along_a * a.direction + b.origin + along_b * b.direction);
}

/// Best matches that are clearly better than the second best, both ways.
std::vector<std::pair<std::size_t, std::size_t>> mutual_matches(const Features& a, const Features& b) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (a.descriptors.rows < 2 || b.descriptors.rows < 2) return out;
  const cv::BFMatcher matcher(cv::NORM_L2);
  std::vector<std::vector<cv::DMatch>> forth;
  std::vector<cv::DMatch> back;
  matcher.knnMatch(a.descriptors, b.descriptors, forth, 2);
  matcher.match(b.descriptors, a.descriptors, back);
  for (const auto& match : forth) {
    if (match[0].distance > kMatchRatio * match[1].distance) continue;
    if (back[static_cast<std::size_t>(match[0].trainIdx)].trainIdx != match[0].queryIdx) continue;
    out.emplace_back(match[0].queryIdx, match[0].trainIdx);
  }
  return out;
}

struct Meeting {
  Eigen::Vector3f p_in_map;
  std::array<std::uint8_t, 3> rgb;
};

std::vector<Meeting> triangulate_pair(const ScenePicture& a, const ScenePicture& b, const Features& in_a,
                                      const Features& in_b) {
  std::vector<Meeting> out;
  for (const auto& [i, j] : mutual_matches(in_a, in_b)) {
    const auto p = meeting_point(ray_through(a, in_a.pixels[i]), ray_through(b, in_b.pixels[j]));
    if (!p || reprojection_px(a, *p, in_a.pixels[i]) > kMaxReprojection_px ||
        reprojection_px(b, *p, in_b.pixels[j]) > kMaxReprojection_px) {
      continue;
    }
    out.push_back({p->cast<float>(), in_a.rgb[i]});
  }
  return out;
}

io::PointCloud triangulate_all(std::span<const ScenePicture* const> pictures) {
  std::vector<Features> features(pictures.size());
  thread::parallel_for(std::size_t{0}, pictures.size(),
                       [&](std::size_t i) { features[i] = find_features(*pictures[i]); });
  const auto pairs = partner_pairs(pictures);
  std::vector<std::vector<Meeting>> meetings(pairs.size());
  thread::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
    const auto [a, b] = pairs[i];
    meetings[i] = triangulate_pair(*pictures[a], *pictures[b], features[a], features[b]);
  });
  io::PointCloud cloud;
  for (const auto& pair : meetings) {
    for (const Meeting& meeting : pair) {
      cloud.points_m.push_back(meeting.p_in_map);
      cloud.rgb.push_back(meeting.rgb);
    }
  }
  return cloud;
}

}  // namespace

Result<io::PointCloud> triangulate(std::span<const ScenePicture* const> pictures) {
  try {
    return triangulate_all(pictures);
  } catch (const cv::Exception& error) {
    return fail(Errc::kIo, "OpenCV cannot find features in the pictures: " + std::string(error.what()));
  }
}

}  // namespace edgesplat::desk
