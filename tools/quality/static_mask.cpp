// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/static_mask.hpp"

#include "common/io/atomic_file.hpp"

#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace edgesplat::quality {
namespace {

constexpr const char* kFile = "espnetv2_s2_city_384x640.onnx";
constexpr int kInputWidth_px = 640, kInputHeight_px = 384;
constexpr int kLabelWidth_px = 320, kLabelHeight_px = 192;
constexpr int kClasses = 20;
constexpr int kFirstMover = 11,
              kLastMover = 18;  // person, rider, car, truck, bus, train, motorcycle, bicycle
constexpr std::array<double, 3> kMean = {0.485, 0.456, 0.406};  // ImageNet's, of 0..1
constexpr std::array<double, 3> kSigma = {0.229, 0.224, 0.225};

constexpr int kRoad = 0, kSidewalk = 1, kTerrain = 9;

/// A label covers 4 px of a picture 1242 px wide and may be off by one at an edge; one more for the colours
/// that resampling and JPEG carry across it.
constexpr int kMargin_px = 5;
/// On each side of a region, of its larger extent.
constexpr double kShadowReach = 0.15;
/// Smaller regions are mistakes: four labels at 1242 px.
constexpr int kLeastRegion_px = 32;

/// [1,3,384,640], plain bilinear resize, as the network was trained. In floats: rounded to 8 bits, up to
/// one label in forty comes out another.
cv::Mat blob_of(const sensor::ImageRgb8& picture) {
  const cv::Mat rgb(picture.height_px, picture.width_px, CV_8UC3,
                    const_cast<std::uint8_t*>(picture.values.data()));
  cv::Mat floats;
  rgb.convertTo(floats, CV_32FC3);
  cv::Mat blob = cv::dnn::blobFromImage(floats, 1.0 / 255.0, cv::Size(kInputWidth_px, kInputHeight_px),
                                        cv::Scalar(255.0 * kMean[0], 255.0 * kMean[1], 255.0 * kMean[2]));
  for (int c = 0; c < 3; ++c) {
    cv::Mat plane(kInputHeight_px, kInputWidth_px, CV_32F, blob.ptr<float>(0, c));
    plane /= kSigma[static_cast<std::size_t>(c)];
  }
  return blob;
}

/// The likeliest class of [1,20,192,320] in each pixel.
cv::Mat labels_of(const cv::Mat& logits) {
  constexpr int kPixels = kLabelWidth_px * kLabelHeight_px;
  cv::Mat labels(kLabelHeight_px, kLabelWidth_px, CV_8U);
  const auto* of_class = logits.ptr<float>();
  auto* label = labels.ptr<std::uint8_t>();
  for (int i = 0; i < kPixels; ++i) {
    int best = 0;
    for (int k = 1; k < kClasses; ++k) {
      if (of_class[k * kPixels + i] > of_class[best * kPixels + i]) best = k;
    }
    label[i] = static_cast<std::uint8_t>(best);
  }
  return labels;
}

cv::Mat square(int margin_px) {
  return cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * margin_px + 1, 2 * margin_px + 1));
}

/// Sets the ground around the regions of one class. Both: 255 where the picture shows that class, or ground.
void mark_shadows(const cv::Mat& of_class, const cv::Mat& ground, cv::Mat& marked) {
  cv::Mat regions, boxes, centres;
  const int count = cv::connectedComponentsWithStats(of_class, regions, boxes, centres);
  for (int region = 1; region < count; ++region) {
    if (boxes.at<int>(region, cv::CC_STAT_AREA) < kLeastRegion_px) continue;
    const cv::Rect box(boxes.at<int>(region, cv::CC_STAT_LEFT), boxes.at<int>(region, cv::CC_STAT_TOP),
                       boxes.at<int>(region, cv::CC_STAT_WIDTH), boxes.at<int>(region, cv::CC_STAT_HEIGHT));
    const int extent_px = std::max(box.width, box.height);
    const int margin_px = std::max(kMargin_px, static_cast<int>(std::lround(kShadowReach * extent_px)));
    const cv::Rect around = cv::Rect(box.x - margin_px, box.y - margin_px, box.width + 2 * margin_px,
                                     box.height + 2 * margin_px) &
                            cv::Rect(0, 0, of_class.cols, of_class.rows);
    cv::Mat grown;
    cv::dilate(regions(around) == region, grown, square(margin_px));
    marked(around).setTo(255, grown & ground(around));
  }
}

std::vector<float> weight_of(const cv::Mat& left_out) {
  std::vector<float> weight(left_out.total());
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = left_out.data[i] == 0 ? 1.0F : 0.0F;
  return weight;
}

bool has_expected_shape(const cv::Mat& logits) {
  return logits.type() == CV_32F && logits.dims == 4 && logits.size[0] == 1 && logits.size[1] == kClasses &&
         logits.size[2] == kLabelHeight_px && logits.size[3] == kLabelWidth_px;
}

}  // namespace

struct StaticMask::Network {
  cv::dnn::Net net;

  cv::Mat logits(const sensor::ImageRgb8& picture) {
    net.setInput(blob_of(picture));
    return net.forward();
  }
};

StaticMask::StaticMask(std::unique_ptr<Network> network) : network_(std::move(network)) {}
StaticMask::StaticMask(StaticMask&&) noexcept = default;
StaticMask& StaticMask::operator=(StaticMask&&) noexcept = default;
StaticMask::~StaticMask() = default;

Result<StaticMask> StaticMask::load(const std::filesystem::path& folder) {
  EDGESPLAT_TRY(const auto onnx, io::read_file(folder / kFile, std::uint64_t{1} << 28U));
  const std::string name = (folder / kFile).string();
  auto network = std::make_unique<Network>();
  try {
    network->net = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(onnx.data()), onnx.size());
    if (!has_expected_shape(network->logits(sensor::ImageRgb8(kInputWidth_px, kInputHeight_px)))) {
      return fail(Errc::kCorrupt, name + ": not ESPNetv2 for the 20 classes of Cityscapes at 640x384");
    }
  } catch (const cv::Exception& error) {
    return fail(Errc::kCorrupt, name + ": OpenCV cannot use the network: " + error.what());
  }
  return StaticMask(std::move(network));
}

Result<StaticWeights> StaticMask::weights(const sensor::ImageRgb8& picture) {
  if (picture.empty()) return fail(Errc::kInvalidArgument, "an empty picture has no static pixels");
  try {
    cv::Mat labels;
    cv::resize(labels_of(network_->logits(picture)), labels, cv::Size(picture.width_px, picture.height_px),
               0.0, 0.0, cv::INTER_NEAREST);
    cv::Mat movers(labels.size(), CV_8U, cv::Scalar(0));
    cv::Mat shadows = movers.clone();
    const cv::Mat ground = (labels == kRoad) | (labels == kSidewalk) | (labels == kTerrain);
    for (int mover = kFirstMover; mover <= kLastMover; ++mover) {
      const cv::Mat of_class = labels == mover;
      movers |= of_class;
      mark_shadows(of_class, ground, shadows);
    }
    constexpr int kSide_px = 2 * kMargin_px + 1;
    cv::dilate(movers, movers, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(kSide_px, kSide_px)));
    return StaticWeights{weight_of(movers), weight_of(movers | shadows)};
  } catch (const cv::Exception& error) {
    return fail(Errc::kIo, "static mask: " + std::string(error.what()));
  }
}

}  // namespace edgesplat::quality
