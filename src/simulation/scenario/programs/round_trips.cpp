// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/round_trips.hpp"

namespace takt::scenario {

RoundTrips::RoundTrips(const ResolvedProgram& program, std::span<const sim::Duration> instants) {
  for (const ResolvedReply& reply : program.replies) {
    One one(instants);
    one.request = reply.to;
    one.with = reply.with;
    one.asker = program.process_data[reply.to].from;
    one.requests.resize(memory);
    one.answered.resize(memory);
    replies_.push_back(std::move(one));
  }
}

void RoundTrips::on_published(std::uint8_t data_set, std::uint16_t sequence, sim::TrueTime now) {
  for (One& one : replies_)
    if (one.request == data_set) one.requests[sequence % memory] = {now, sequence};
}

void RoundTrips::on_replied(std::size_t reply, std::uint16_t sequence, std::uint16_t request, sim::TrueTime now) {
  One& one = replies_[reply];
  const Sent& sent = one.requests[request % memory];
  if (sent.sequence != request || sent.time == sim::TrueTime::never()) return;
  one.times.add(sent.time, [&](Times& times) { times.one_way.add(now - sent.time); });
  one.answered[sequence % memory] = {sent.time, sequence};
}

void RoundTrips::on_received(std::uint8_t data_set, std::uint16_t sequence, std::size_t to, sim::TrueTime now) {
  for (One& one : replies_) {
    if (one.with != data_set || one.asker != to) continue;
    Sent& sent = one.answered[sequence % memory];
    if (sent.sequence != sequence || sent.time == sim::TrueTime::never()) continue;
    one.times.add(sent.time, [&](Times& times) { times.round_trips.add(now - sent.time); });
    sent.time = sim::TrueTime::never();
  }
}

}  // namespace takt::scenario
