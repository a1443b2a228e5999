// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/opc_ua_port.hpp"

#include "sim/check.hpp"

namespace takt::scenario {

using application::OpcUaAddress;
using application::TopicShape;

namespace {

/// Local time 0 as time stamps tell it: 1970-01-01, where clocks that gPTP synchronises begin.
constexpr uadp::DateTime begin_of_time{116'444'736'000'000'000};

/// Messages that wait in a socket: as many as a socket buffer of 208 KiB, the usual size on Linux, holds of small ones.
class Inbox {
 public:
  static constexpr std::size_t most_messages = 256;
  static constexpr std::size_t most_octets = 1472;

  void put(uadp::Octets message) {
    if (waiting_ == most_messages || message.size() > most_octets) return;
    std::vector<std::byte>& place = messages_[(first_ + waiting_) % most_messages];
    place.assign(message.begin(), message.end());
    ++waiting_;
  }
  /// The octets last until the next call of either.
  uadp::Octets take() {
    if (waiting_ == 0) return {};
    const uadp::Octets message = messages_[first_];
    --waiting_;
    first_ = waiting_ == 0 ? 0 : (first_ + 1) % most_messages;
    return message;
  }

 private:
  std::vector<std::vector<std::byte>> messages_ = std::vector<std::vector<std::byte>>(most_messages);
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
};

}  // namespace

OpcUaAddress address_of(const ResolvedTopic& topic, const ResolvedThread& publication) {
  return {topic.publisher_id, publication.writer_group};
}

OpcUaWriter::OpcUaWriter(const TopicShape& topic, const OpcUaAddress& address,
                         std::optional<models::StreamIndex> stream)
    : topic_(&topic), address_(address), stream_(stream) {}

void OpcUaWriter::start(models::HostServices& host) {
  publication_.reset(new application::OpcUaPublication(*topic_, address_, *this, host.now(), begin_of_time));
}

void OpcUaWriter::crash() { publication_.reset(); }

WriteOutcome OpcUaWriter::write(models::HostServices& host, uadp::Octets value) {
  host_ = &host;
  const bool published = publication_->publish(value, host.now());
  TAKT_CHECK(published, "values have the fields of their topic");
  host_ = nullptr;
  return WriteOutcome::published;
}

void OpcUaWriter::publish(uadp::Octets network_message, const pubsub::Destination&) {
  if (host_ != nullptr && stream_) host_->send(*stream_, network_message);
}

struct OpcUaReader::Subscribing {
  application::OpcUaSubscription subscription;
  Inbox inbox = {};
};

OpcUaReader::OpcUaReader(const TopicShape& topic, std::vector<OpcUaAddress> heard)
    : topic_(&topic), heard_(std::move(heard)) {}
OpcUaReader::~OpcUaReader() = default;

void OpcUaReader::start(models::HostServices& host) {
  subscribing_.reset(new Subscribing{{*topic_, heard_, host.now()}});
}

void OpcUaReader::crash() {
  lost_ = lost();
  subscribing_.reset();
}

void OpcUaReader::receive(models::HostServices&, uadp::Octets message) {
  subscribing_->inbox.put(message);  // what finds no room leaves a gap in the numbers
}

std::optional<uadp::Octets> OpcUaReader::next(models::HostServices& host) {
  for (uadp::Octets message = subscribing_->inbox.take(); !message.empty(); message = subscribing_->inbox.take())
    if (const auto value = subscribing_->subscription.receive(message, host.now())) return value;
  return std::nullopt;
}

std::uint64_t OpcUaReader::lost() const { return lost_ + (subscribing_ ? subscribing_->subscription.lost() : 0); }

}  // namespace takt::scenario
