// SPDX-License-Identifier: Apache-2.0
// Outbox: messages on their way out of a participant, as the octets of UDP payloads.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "dds/message/encoder.hpp"
#include "dds/rtps/figures.hpp"

namespace takt::dds {

/// Where a message goes, and with which TRANSPORT_PRIORITY.
struct Route {
  std::vector<Locator> destinations;
  std::optional<GuidPrefix> only;  ///< INFO_DST: for this participant alone
  std::int32_t transport_priority = 0;
};

struct OutgoingDatagram {
  std::vector<Locator> destinations;
  std::int32_t transport_priority = 0;
  std::vector<std::byte> octets;
};

class Outbox {
 public:
  /// No message gets longer than `max_message` octets (88 to 65507).
  Outbox(const GuidPrefix& prefix, std::size_t max_message);

  /// Begins a message; the one before is complete.
  void begin(const Route& route);
  /// Into the message at hand, or into a new one on the same route if it is full. Precondition: it fits into an empty
  /// one.
  void add(const Submessage& submessage);
  /// Octets of the message at hand.
  std::size_t size() const { return encoder_ ? encoder_->size() : 0; }
  void end();

  /// A message that was made elsewhere.
  void post(std::vector<Locator> destinations, Octets octets);

  /// What goes to these is given back by drain_looped(), and is not sent to the first, which is the participant's own
  /// address.
  void set_own(const Locator& unicast, const std::optional<Locator>& multicast);
  std::optional<std::vector<std::byte>> drain_looped();

  bool is_empty() const { return ready_.empty(); }
  /// The next message; valid until the next call.
  const OutgoingDatagram* next();

  Figures& figures() { return figures_; }
  const Figures& figures() const { return figures_; }

 private:
  void open();

  GuidPrefix prefix_;
  std::size_t max_message_;
  std::optional<MessageEncoder> encoder_;
  std::size_t preamble_ = 0;  ///< octets of the message at hand that say nothing by themselves
  bool is_directed_ = false;
  GuidPrefix only_;
  OutgoingDatagram at_hand_;
  std::deque<OutgoingDatagram> ready_;
  OutgoingDatagram given_;
  std::vector<std::vector<std::byte>> spare_;
  std::optional<Locator> own_;
  std::optional<Locator> own_group_;
  std::deque<std::vector<std::byte>> looped_;
  Figures figures_;
};

}  // namespace takt::dds
