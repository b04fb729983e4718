// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Part of the transport: libaravis' headers stay behind it.
#pragma once

#include "robot/drivers/aravis/feature_access.hpp"

#include <arv.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::aravis {

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <typename T>
using GObjectPtr = std::unique_ptr<T, Unref>;

/// Takes a GError, where a call left one, as an Error: kNotFound for features that are not there, else
/// kUnavailable.
class ErrorSlot {
 public:
  ErrorSlot() = default;
  ErrorSlot(const ErrorSlot&) = delete;
  ErrorSlot& operator=(const ErrorSlot&) = delete;
  ~ErrorSlot() { g_clear_error(&error_); }
  [[nodiscard]] GError** out() { return &error_; }
  [[nodiscard]] Status status(std::string_view what) const;

 private:
  GError* error_ = nullptr;
};

/// The features of an open camera. `camera` must outlive it.
class AravisFeatures final : public FeatureAccess {
 public:
  explicit AravisFeatures(ArvCamera* camera) : camera_(camera) {}

  [[nodiscard]] bool has(std::string_view name) const override;
  [[nodiscard]] std::vector<std::string> choices(std::string_view name) const override;
  [[nodiscard]] Status set(std::string_view name, bool value) override;
  [[nodiscard]] Status set(std::string_view name, std::int64_t value) override;
  [[nodiscard]] Status set(std::string_view name, double value) override;
  [[nodiscard]] Status choose(std::string_view name, std::string_view entry) override;
  [[nodiscard]] Status execute(std::string_view name) override;
  [[nodiscard]] Result<std::int64_t> integer(std::string_view name) override;
  [[nodiscard]] Result<double> number(std::string_view name) override;
  [[nodiscard]] Result<std::string> chosen(std::string_view name) override;

 private:
  ArvCamera* camera_;
};

}  // namespace edgesplat::aravis
