// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/bvh.hpp"

#include <limits>
#include <numeric>

namespace edgesplat::simulate {
namespace {

constexpr int kBins = 12;
constexpr std::size_t kLeafSize = 2;
/// Boxes grow by this, so that rounding to float never loses a surface within 200 m.
constexpr double kMargin_m = 1e-4;

double area(const Bounds& b) {
  const Eigen::Vector3d d = (b.hi_m - b.lo_m).cwiseMax(0.0);
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int bin = 0;  ///< the last one on the left
};

/// Cheapest cut between bins: summed area times count on either side.
Cut best_cut(const std::array<Bounds, kBins>& boxes, const std::array<int, kBins>& counts) {
  std::array<double, kBins> right{};
  Bounds grown;
  int count = 0;
  for (std::size_t i = kBins - 1; i > 0; --i) {
    grown.extend(boxes[i]);
    count += counts[i];
    right[i] = count > 0 ? area(grown) * count : 0.0;
  }
  Cut best;
  grown = Bounds{};
  count = 0;
  for (std::size_t i = 0; i + 1 < kBins; ++i) {
    grown.extend(boxes[i]);
    count += counts[i];
    const double cost = (count > 0 ? area(grown) * count : 0.0) + right[i + 1];
    if (cost < best.cost) best = {cost, static_cast<int>(i)};
  }
  return best;
}

}  // namespace

Bvh::Bvh(std::span<const Bounds> boxes) {
  if (boxes.empty()) return;
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    items.push_back({boxes[i], (boxes[i].lo_m + boxes[i].hi_m) / 2.0, static_cast<std::uint32_t>(i)});
  nodes_.reserve(2 * boxes.size());
  nodes_.push_back({});
  split(0, items, 0);
  order_.reserve(items.size());
  for (const Item& item : items) order_.push_back(item.index);
}

void Bvh::enclose(Node& node, const Bounds& box) {
  for (int i = 0; i < 3; ++i) {
    node.lo_m[i] = static_cast<float>(box.lo_m[i] - kMargin_m);
    node.hi_m[i] = static_cast<float>(box.hi_m[i] + kMargin_m);
  }
}

void Bvh::split(std::uint32_t node, std::span<Item> items, std::uint32_t first) {
  Bounds box, centres;
  for (const Item& item : items) {
    box.extend(item.box);
    centres.extend({item.centre, item.centre});
  }
  enclose(nodes_[node], box);
  nodes_[node].first = first;
  nodes_[node].count = static_cast<std::uint32_t>(items.size());
  int axis = 0;
  const double spread = (centres.hi_m - centres.lo_m).maxCoeff(&axis);
  if (items.size() <= kLeafSize || spread < 1e-9) return;

  const auto bin_of = [&](const Item& item) {
    return std::clamp(static_cast<int>((item.centre[axis] - centres.lo_m[axis]) / spread * kBins), 0,
                      kBins - 1);
  };
  std::array<Bounds, kBins> boxes;
  std::array<int, kBins> counts{};
  for (const Item& item : items) {
    boxes[static_cast<std::size_t>(bin_of(item))].extend(item.box);
    ++counts[static_cast<std::size_t>(bin_of(item))];
  }
  const Cut cut = best_cut(boxes, counts);
  auto middle =
      std::partition(items.begin(), items.end(), [&](const Item& i) { return bin_of(i) <= cut.bin; });
  auto left_size = static_cast<std::size_t>(middle - items.begin());
  if (left_size == 0 || left_size == items.size()) left_size = items.size() / 2;

  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = left;
  nodes_[node].count = 0;
  split(left, items.first(left_size), first);
  split(left + 1, items.subspan(left_size), first + static_cast<std::uint32_t>(left_size));
}

}  // namespace edgesplat::simulate
