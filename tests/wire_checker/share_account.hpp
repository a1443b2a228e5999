// SPDX-License-Identifier: Apache-2.0
// Whose turn it is among classes that share bandwidth (ETS), counted along what is seen on the wire: deficit round
// robin, visit by visit.
#pragma once

#include <array>
#include <cstdint>

#include "models/egress/shaping_config.hpp"

namespace takt::wire_checker {

class ShareAccount {
 public:
  using PerClass = std::array<std::int64_t, models::traffic_class_count>;

  explicit ShareAccount(const models::ShapingConfig& config) {
    for (std::size_t q = 0; q < percent_.size(); ++q)
      if (const auto* const share = std::get_if<models::EnhancedTransmissionSelection>(&config.selection[q]))
        percent_[q] = share->bandwidth;
  }

  /// Who sends next: `heads` are the octets that the first frame of each class takes on the medium, 0 of those that
  /// cannot start.
  models::TrafficClass next(const PerClass& heads) {
    bool goes_on = true;  // whoever was visited last
    for (;; goes_on = false, turn_ = turn_ == 0 ? heads.size() - 1 : turn_ - 1) {
      if (heads[turn_] == 0) continue;
      if (!goes_on) left_[turn_] += percent_[turn_];
      if (left_[turn_] >= heads[turn_]) return static_cast<models::TrafficClass>(turn_);
    }
  }
  void pay(models::TrafficClass q, std::int64_t octets) { left_[q] -= octets; }
  void empty(models::TrafficClass q) { left_[q] = 0; }

 private:
  PerClass percent_{};
  PerClass left_{};
  std::size_t turn_ = 0;
};

}  // namespace takt::wire_checker
