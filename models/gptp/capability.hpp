// SPDX-License-Identifier: Apache-2.0
// Whether the neighbour at a port says that it is capable of gPTP in a domain, IEEE 802.1AS-2020 10.4:
// GptpCapableTransmit and GptpCapableReceive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "models/gptp/output.hpp"

namespace takt::models::gptp {

/// Of one port and one domain. Sends Signaling with the gPTP-capable TLV at its interval and listens for the
/// neighbour's: nine of the neighbour's intervals without one (gPtpCapableReceiptTimeout), and it is capable no longer.
/// Without an interval nothing is sent, and neighbours are taken at their word.
class Capability {
 public:
  static constexpr int receipt_timeout = 9;
  static constexpr int longest_interval = 24;  ///< 2^24 s; what a neighbour announces beyond is not believed

  Capability(std::optional<std::int8_t> log_interval, PortIdentity self, std::uint8_t domain, std::uint8_t instance)
      : log_interval_(log_interval), self_(self), domain_(domain), instance_(instance) {}

  void link_up(sim::LocalTime now, Outputs& outputs) {
    up_ = true;
    next_ = now;
    interval_elapsed(now, outputs);
  }
  void link_down(Outputs& outputs) {
    up_ = hears_ = false;
    if (!log_interval_) return;
    outputs.push_back(CancelTimer{timer(TimerPurpose::gptp_capable_interval)});
    outputs.push_back(CancelTimer{timer(TimerPurpose::gptp_capable_receipt)});
  }
  /// The timer gptp_capable_interval.
  void interval_elapsed(sim::LocalTime now, Outputs& outputs) {
    if (!up_ || !log_interval_) return;
    Signaling message = next_message();
    message.capable = GptpCapable{*log_interval_};
    outputs.push_back(SendMessage{self_.port, message});
    next_ = std::max(next_ + interval_of(*log_interval_), now);
    outputs.push_back(ArmTimer{timer(TimerPurpose::gptp_capable_interval), next_});
  }
  /// The timer gptp_capable_receipt.
  void receipt_elapsed() { hears_ = false; }
  /// Precondition: is_meant().
  void received(const Signaling& message, sim::LocalTime now, Outputs& outputs) {
    if (!up_ || !log_interval_ || !message.capable) return;
    const int interval = message.capable->log_interval;
    if (interval < -longest_interval || interval > longest_interval) return;
    hears_ = true;
    outputs.push_back(
        ArmTimer{timer(TimerPurpose::gptp_capable_receipt), now + interval_of(interval) * receipt_timeout});
  }

  /// It comes from another node, and this port is meant.
  bool is_meant(const Signaling& message) const {
    return message.header.source.clock != self_.clock &&
           (message.target == PortIdentity::all() || message.target == self_);
  }
  /// An empty Signaling of the port in the domain, for whatever has to be said.
  Signaling next_message() {
    Signaling message;
    message.header.source = self_;
    message.header.domain = domain_;
    message.header.sequence_id = next_sequence_++;
    return message;
  }

  bool is_up() const { return up_; }
  /// neighborGptpCapable.
  bool is_neighbor_capable() const { return !log_interval_ || hears_; }

 private:
  TimerId timer(TimerPurpose purpose) const { return {instance_, self_.port, purpose}; }

  std::optional<std::int8_t> log_interval_;
  PortIdentity self_;
  std::uint8_t domain_;
  std::uint8_t instance_;
  bool up_ = false;
  bool hears_ = false;
  std::uint16_t next_sequence_ = 0;
  sim::LocalTime next_;
};

}  // namespace takt::models::gptp
