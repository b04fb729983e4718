// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/lpips.hpp"

#include "common/io/atomic_file.hpp"

#include <opencv2/dnn.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::quality {
namespace {

constexpr std::array<const char*, 5> kLayers = {"relu1", "relu2", "relu3", "relu4", "relu5"};
constexpr std::array<int, 5> kChannels = {64, 192, 384, 256, 256};
constexpr std::size_t kWeights = 64 + 192 + 384 + 256 + 256;
constexpr int kLeastSide_px = 64;

/// Mean over the pixels of the weighted square difference of features scaled to unit length.
double layer_distance(const cv::Mat& a, const cv::Mat& b, std::span<const float> weights) {
  const auto channels = static_cast<std::size_t>(a.size[1]);
  const auto pixels = static_cast<std::size_t>(a.size[2]) * static_cast<std::size_t>(a.size[3]);
  const float* first = a.ptr<float>();
  const float* second = b.ptr<float>();
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    double norm_a = 0.0, norm_b = 0.0;
    for (std::size_t c = 0; c < channels; ++c) {
      const auto va = static_cast<double>(first[c * pixels + i]),
                 vb = static_cast<double>(second[c * pixels + i]);
      norm_a += va * va;
      norm_b += vb * vb;
    }
    norm_a = std::sqrt(norm_a) + 1e-10;
    norm_b = std::sqrt(norm_b) + 1e-10;
    for (std::size_t c = 0; c < channels; ++c) {
      const double difference = static_cast<double>(first[c * pixels + i]) / norm_a -
                                static_cast<double>(second[c * pixels + i]) / norm_b;
      sum += static_cast<double>(weights[c]) * difference * difference;
    }
  }
  return sum / static_cast<double>(pixels);
}

}  // namespace

struct Lpips::Network {
  cv::dnn::Net net;
  std::vector<cv::String> outputs;
  std::vector<float> weights;

  std::vector<cv::Mat> features(const sensor::ImageRgb8& picture) {
    const cv::Mat rgb(picture.height_px, picture.width_px, CV_8UC3,
                      const_cast<std::uint8_t*>(picture.values.data()));
    net.setInput(cv::dnn::blobFromImage(rgb, 1.0 / 127.5, cv::Size(), cv::Scalar(127.5, 127.5, 127.5)));
    std::vector<cv::Mat> layers;
    net.forward(layers, outputs);
    for (cv::Mat& layer : layers) layer = layer.clone();  // the network reuses its memory
    return layers;
  }
  double distance(const sensor::ImageRgb8& a, const sensor::ImageRgb8& b) {
    const auto of_a = features(a), of_b = features(b);
    double sum = 0.0;
    std::size_t offset = 0;
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
      const auto count = static_cast<std::size_t>(kChannels[i]);
      sum += layer_distance(of_a[i], of_b[i], std::span(weights).subspan(offset, count));
      offset += count;
    }
    return sum;
  }
};

Lpips::Lpips(std::unique_ptr<Network> network) : network_(std::move(network)) {}
Lpips::Lpips(Lpips&&) noexcept = default;
Lpips& Lpips::operator=(Lpips&&) noexcept = default;
Lpips::~Lpips() = default;

Result<Lpips> Lpips::load(const std::filesystem::path& folder) {
  auto network = std::make_unique<Network>();
  EDGESPLAT_TRY(const auto weights, io::read_file(folder / "lpips_alex_lin.f32", 1U << 20U));
  EDGESPLAT_TRY(const auto onnx,
                io::read_file(folder / "lpips_alex_feats_256x256.onnx", std::uint64_t{1} << 28U));
  if (weights.size() != kWeights * sizeof(float)) {
    return fail(Errc::kCorrupt, (folder / "lpips_alex_lin.f32").string() + " does not hold " +
                                    std::to_string(kWeights) + " weights");
  }
  network->weights.resize(kWeights);
  std::memcpy(network->weights.data(), weights.data(), weights.size());
  try {
    network->net = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(onnx.data()), onnx.size());
    for (const char* layer : kLayers) network->outputs.emplace_back(layer);
    const auto probe = network->features(sensor::ImageRgb8(kLeastSide_px, kLeastSide_px));
    for (std::size_t i = 0; i < kLayers.size(); ++i) {
      if (probe[i].dims != 4 || probe[i].size[1] != kChannels[i]) {
        return fail(Errc::kCorrupt, folder.string() + ": not the network of LPIPS");
      }
    }
  } catch (const cv::Exception& error) {
    return fail(Errc::kCorrupt, folder.string() + ": OpenCV cannot use the network: " + error.what());
  }
  return Lpips(std::move(network));
}

Result<double> Lpips::distance(const sensor::ImageRgb8& a, const sensor::ImageRgb8& b) {
  if (a.width_px != b.width_px || a.height_px != b.height_px || a.width_px < kLeastSide_px ||
      a.height_px < kLeastSide_px) {
    return fail(Errc::kInvalidArgument, "LPIPS compares pictures of one size with sides of at least 64 px");
  }
  try {
    return network_->distance(a, b);
  } catch (const cv::Exception& error) {
    return fail(Errc::kIo, "LPIPS: " + std::string(error.what()));
  }
}

}  // namespace edgesplat::quality
