// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <deque>
#include <mutex>

#include "application/opc_ua_topic.hpp"
#include "node/applications/topic_end.hpp"
#include "uadp/network_message.hpp"

namespace takt::node {

namespace {

uadp::DateTime utc_at_begin() {
  constexpr std::int64_t ticks_from_1601_to_1970 = 116'444'736'000'000'000;
  const auto since_1970 =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch());
  return {ticks_from_1601_to_1970 + since_1970.count() / 100};
}

/// Of a message that no subscription takes.
wire::Verdict verdict_of_untaken(uadp::Octets octets) {
  uadp::NetworkMessage message;
  switch (uadp::decode(octets, message)) {
    case uadp::DecodeStatus::ok:
      return wire::Verdict::unsubscribed;
    case uadp::DecodeStatus::secured:
      return wire::Verdict::secured;
    default:
      return wire::Verdict::not_uadp;
  }
}

}  // namespace

struct OpcUaTopics::Shared {
  Shared(std::unique_ptr<Socket> given, std::int64_t (*clock)())
      : socket(std::move(given)), now_ns(clock), epoch_ns(clock()), epoch(utc_at_begin()) {}

  sim::LocalTime now() const { return sim::LocalTime::from_ps((now_ns() - epoch_ns) * 1000); }
  /// Gives what the socket holds to all readers; what comes while it does so waits for the next time. With the lock
  /// held.
  void distribute();
  static constexpr int most_at_once = 1024;  // more than a socket holds

  std::mutex mutex;  ///< of all that is below
  std::unique_ptr<Socket> socket;
  std::int64_t (*now_ns)();
  std::int64_t epoch_ns;
  uadp::DateTime epoch;  ///< UTC then, for time stamps
  std::vector<std::unique_ptr<Writer>> writers;
  std::vector<std::unique_ptr<Reader>> readers;
  SourceTable sources;
};

class OpcUaTopics::Writer final : public TopicWriter {
 public:
  Writer(Shared& shared, const LoadedTopic& topic, std::uint16_t writer_group)
      : shared_(shared),
        publication_(topic.shape, {topic.publisher_id, writer_group}, *shared.socket, shared.now(), shared.epoch) {}

  SendOutcome write(uadp::Octets value) override {
    const std::lock_guard lock(shared_.mutex);
    const std::uint64_t failures = shared_.socket->send_failures();
    const bool published = publication_.publish(value, shared_.now());
    return published && shared_.socket->send_failures() == failures ? SendOutcome::sent : SendOutcome::failed;
  }

 private:
  Shared& shared_;
  application::OpcUaPublication publication_;
};

class OpcUaTopics::Reader final : public TopicReader {
 public:
  Reader(Shared& shared, const LoadedTopic& topic)
      : shared_(shared), subscription_(topic.shape, heard(topic), shared.now()) {}

  std::span<const std::vector<std::byte>> take() override {
    const std::lock_guard lock(shared_.mutex);
    shared_.distribute();
    taken_.assign(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    return taken_;
  }
  std::uint64_t lost() const override { return subscription_.lost(); }

  /// False if it is not for this one.
  bool receive(uadp::Octets message) {
    const auto value = subscription_.receive(message, shared_.now());
    if (!value) return false;
    if (waiting_.size() == most_taken) waiting_.pop_front();
    waiting_.emplace_back(value->begin(), value->end());
    return true;
  }

 private:
  static std::vector<application::OpcUaAddress> heard(const LoadedTopic& topic) {
    std::vector<application::OpcUaAddress> all;
    for (std::uint16_t each = 1; each <= topic.writer_groups; ++each) all.push_back({topic.publisher_id, each});
    return all;
  }

  Shared& shared_;
  application::OpcUaSubscription subscription_;
  std::deque<std::vector<std::byte>> waiting_;  ///< the newest that no thread has taken
  std::vector<std::vector<std::byte>> taken_;
};

void OpcUaTopics::Shared::distribute() {
  for (int i = 0; i < most_at_once; ++i) {
    const auto arrival = socket->take();
    if (!arrival) return;
    wire::Verdict verdict = arrival->verdict;  // of what is refused, too: a flood of it does not hold the lock
    if (verdict == wire::Verdict::taken) {
      bool is_taken = false;
      for (const auto& reader : readers) is_taken = reader->receive(arrival->message) || is_taken;
      if (!is_taken) verdict = verdict_of_untaken(arrival->message);
    }
    sources.count(*arrival, verdict, now_ns());
  }
}

OpcUaTopics::OpcUaTopics(std::unique_ptr<Socket> socket, std::int64_t (*now_ns)())
    : shared_(std::make_unique<Shared>(std::move(socket), now_ns)) {}
OpcUaTopics::~OpcUaTopics() = default;

TopicWriter& OpcUaTopics::add_writer(const LoadedTopic& topic, std::uint16_t writer_group) {
  return *shared_->writers.emplace_back(std::make_unique<Writer>(*shared_, topic, writer_group));
}
TopicReader& OpcUaTopics::add_reader(const LoadedTopic& topic) {
  return *shared_->readers.emplace_back(std::make_unique<Reader>(*shared_, topic));
}
std::vector<HeardSource> OpcUaTopics::sources() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->sources.all();
}
std::uint64_t OpcUaTopics::send_failures() const { return shared_->socket->send_failures(); }

}  // namespace takt::node
