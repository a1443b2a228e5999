// SPDX-License-Identifier: Apache-2.0
#include "pubsub/communication.hpp"

#include <algorithm>

namespace takt::pubsub {

Communication::Communication(PublishedData& published, SubscribedData& subscribed)
    : published_(published), subscribed_(subscribed) {
  component_.disable();
}

bool Communication::add_publisher(Publisher& publisher) {
  for (const Publisher* each : publishers_)
    if (each->id() == publisher.id()) return false;
  publishers_.push_back(&publisher);
  publisher.update(state(), sim::LocalTime());
  return true;
}

bool Communication::add_subscriber(Subscriber& subscriber) {
  if (std::find(subscribers_.begin(), subscribers_.end(), &subscriber) != subscribers_.end()) return false;
  subscribers_.push_back(&subscriber);
  subscriber.update(state());
  return true;
}

StatusCode Communication::enable(sim::LocalTime now) {
  const StatusCode status = component_.enable();
  update(now);
  return status;
}

StatusCode Communication::disable(sim::LocalTime now) {
  const StatusCode status = component_.disable();
  update(now);
  return status;
}

void Communication::update(sim::LocalTime now) {
  for (Publisher* each : publishers_) each->update(state(), now);
  for (Subscriber* each : subscribers_) each->update(state());
}

void Communication::poll(sim::LocalTime now, std::size_t most) {
  for (std::size_t i = 0; i < most; ++i) {
    const uadp::Octets octets = subscribed_.next();
    if (octets.empty()) return;
    received(octets, now);
  }
}

void Communication::received(uadp::Octets network_message, sim::LocalTime now) {
  uadp::NetworkMessage message;
  const uadp::DecodeStatus verdict = decode(network_message, message);
  verdicts_.count(verdict);
  if (verdict != uadp::DecodeStatus::ok) return;
  bool wanted = false;
  for (Subscriber* each : subscribers_) wanted = each->received(message, now) || wanted;
  if (!wanted) ++unwanted_;
}

sim::LocalTime Communication::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const Publisher* each : publishers_) next = std::min(next, each->next_time());
  for (const Subscriber* each : subscribers_) next = std::min(next, each->next_time());
  return next;
}

void Communication::advance(sim::LocalTime now) {
  for (Subscriber* each : subscribers_) each->advance(now);
  for (Publisher* each : publishers_) each->advance(now, published_);
}

}  // namespace takt::pubsub
