// SPDX-License-Identifier: Apache-2.0
// Communication: all that a Program publishes and subscribes to, over one stack (paper, IV, Fig. 7).
#pragma once

#include "pubsub/publisher.hpp"
#include "pubsub/subscriber.hpp"

namespace takt::pubsub {

/// Sans-IO: it is fed with octets and the time of the local clock, and gives octets to the stack. The host calls
/// `advance` at `next_time`, after it has set DataSets that are published on change, and `poll` or `received` when
/// something came. It starts Disabled.
class Communication {
 public:
  Communication(PublishedData& published, SubscribedData& subscribed);

  /// Publishers and Subscribers outlive it. False if it is there already, or another with its PublisherId.
  bool add_publisher(Publisher& publisher);
  bool add_subscriber(Subscriber& subscriber);

  StatusCode enable(sim::LocalTime now);
  StatusCode disable(sim::LocalTime now);
  PubSubState state() const { return component_.state(); }
  /// Call it after a component below was enabled or disabled.
  void update(sim::LocalTime now);

  /// Takes what the stack has received, `most` messages at most: what comes faster than it is taken does not keep the
  /// caller.
  void poll(sim::LocalTime now, std::size_t most = 1024);
  /// Takes one NetworkMessage.
  void received(uadp::Octets network_message, sim::LocalTime now);

  /// When something is due: publishing, or a time-out. Never if nothing is.
  sim::LocalTime next_time() const;
  /// Does all that is due: time-outs, then publishing.
  void advance(sim::LocalTime now);

  /// NetworkMessages by what the decoder said.
  const uadp::DecodeStatusCounts& verdicts() const { return verdicts_; }
  /// Sound NetworkMessages that no Subscriber wanted.
  std::uint64_t unwanted() const { return unwanted_; }

 private:
  PublishedData& published_;
  SubscribedData& subscribed_;
  PubSubComponent component_;
  std::vector<Publisher*> publishers_;
  std::vector<Subscriber*> subscribers_;
  uadp::DecodeStatusCounts verdicts_;
  std::uint64_t unwanted_ = 0;
};

}  // namespace takt::pubsub
