// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/outbox.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::dds {

Outbox::Outbox(const GuidPrefix& prefix, std::size_t max_message) : prefix_(prefix), max_message_(max_message) {}

void Outbox::begin(const Route& route) {
  end();
  at_hand_.destinations = route.destinations;
  at_hand_.transport_priority = route.transport_priority;
  is_directed_ = route.only.has_value();
  if (is_directed_) only_ = *route.only;
  open();
}

void Outbox::open() {
  if (spare_.empty()) spare_.emplace_back();
  at_hand_.octets = std::move(spare_.back());
  spare_.pop_back();
  at_hand_.octets.resize(max_message_);
  MessageHeader header;
  header.prefix = prefix_;
  encoder_.emplace(at_hand_.octets, header);
  if (is_directed_) {
    encoder_->add(InfoDestination{only_});
    figures_.sent.count(SubmessageKind::info_destination);
  }
  preamble_ = encoder_->size();
}

namespace {
SubmessageKind kind_of(const Submessage& submessage) {
  static constexpr std::array kinds{SubmessageKind::pad,
                                    SubmessageKind::data,
                                    SubmessageKind::data_frag,
                                    SubmessageKind::heartbeat,
                                    SubmessageKind::heartbeat_frag,
                                    SubmessageKind::ack_nack,
                                    SubmessageKind::nack_frag,
                                    SubmessageKind::gap,
                                    SubmessageKind::info_timestamp,
                                    SubmessageKind::info_source,
                                    SubmessageKind::info_destination,
                                    SubmessageKind::info_reply};
  static_assert(kinds.size() == std::variant_size_v<Submessage>);
  return kinds[submessage.index()];
}
}  // namespace

void Outbox::add(const Submessage& submessage) {
  TAKT_CHECK(encoder_.has_value(), "a message has begun");
  if (!encoder_->add(submessage)) {
    const std::vector<Locator> destinations = at_hand_.destinations;
    const std::int32_t priority = at_hand_.transport_priority;
    end();
    at_hand_.destinations = destinations;
    at_hand_.transport_priority = priority;
    open();
    const bool fits = encoder_->add(submessage);
    TAKT_CHECK(fits, "a submessage fits into an empty message");
  }
  figures_.sent.count(kind_of(submessage));
}

void Outbox::end() {
  if (!encoder_) return;
  const std::size_t size = encoder_->size();
  encoder_.reset();
  if (size <= preamble_ || at_hand_.destinations.empty()) {
    spare_.push_back(std::move(at_hand_.octets));
    return;
  }
  at_hand_.octets.resize(size);
  if (own_) {
    const bool is_own = std::erase(at_hand_.destinations, *own_) != 0;
    const bool is_group = own_group_ && std::find(at_hand_.destinations.begin(), at_hand_.destinations.end(),
                                                  *own_group_) != at_hand_.destinations.end();
    if (is_own || is_group) looped_.push_back(at_hand_.octets);
    if (at_hand_.destinations.empty()) {
      spare_.push_back(std::move(at_hand_.octets));
      return;
    }
  }
  ++figures_.messages_sent;
  figures_.octets_sent += size;
  figures_.datagrams_sent += at_hand_.destinations.size();
  figures_.datagram_octets_sent += at_hand_.destinations.size() * size;
  ready_.push_back(std::move(at_hand_));
  at_hand_ = {};
}

void Outbox::post(std::vector<Locator> destinations, Octets octets) {
  end();
  ++figures_.messages_sent;
  figures_.octets_sent += octets.size();
  figures_.datagrams_sent += destinations.size();
  figures_.datagram_octets_sent += destinations.size() * octets.size();
  ready_.push_back({std::move(destinations), 0, {octets.begin(), octets.end()}});
}

void Outbox::set_own(const Locator& unicast, const std::optional<Locator>& multicast) {
  own_ = unicast;
  own_group_ = multicast;
}

std::optional<std::vector<std::byte>> Outbox::drain_looped() {
  end();
  if (looped_.empty()) return std::nullopt;
  std::vector<std::byte> octets = std::move(looped_.front());
  looped_.pop_front();
  return octets;
}

const OutgoingDatagram* Outbox::next() {
  end();
  if (ready_.empty()) return nullptr;
  if (given_.octets.capacity() != 0 && spare_.size() < 16) spare_.push_back(std::move(given_.octets));
  given_ = std::move(ready_.front());
  ready_.pop_front();
  return &given_;
}

}  // namespace takt::dds
