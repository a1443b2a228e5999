// SPDX-License-Identifier: Apache-2.0
#include "wire/program_node.hpp"

#include <algorithm>
#include <utility>

#include "wire/nesting.hpp"

namespace takt::wire {

using handshake::Binding;
using handshake::Candidate;
using handshake::Input;
using handshake::Side;

void NodeSettings::set_incarnation(std::uint32_t incarnation) {
  constexpr std::uint32_t most_lives = 0xFF'FFFF;  // of 24 bits, without 0
  endpoint.handshake.incarnation = incarnation;
  if (roles && roles->offer) roles->offer->life = incarnation % most_lives + 1;
}

ProgramNode::ProgramNode(NodeSettings settings) : settings_(std::move(settings)) {
  if (settings_.roles) {
    TAKT_CHECK(settings_.roles->announce_cycle > sim::Duration(), "announcements are repeated");
    TAKT_CHECK(
        table_octets(settings_.roles->format->roles(), settings_.roles->format->candidates()) <= most_message_octets,
        "a table fits into a frame");
  }
  begin();
  if (candidate_ && settings_.roles->offer->joins_at_start) candidate_->join();
  if (endpoint_) peers_ = endpoint_->participant().peer_count();
}

/// Without any memory.
void ProgramNode::begin() {
  arrivals_.clear();
  sequence_ = 0;
  next_other_life_ = {};
  if (settings_.roles && settings_.roles->offer) {
    const Offer& offer = *settings_.roles->offer;
    TAKT_CHECK(offer.life != 0, "0 is no life");
    TAKT_CHECK(settings_.endpoint.handshake.subscription == handshake::Subscription::star,
               "a role hears the master only");
    endpoint_.reset();
    candidate_.emplace(offer.number, offer.life, offer.skills);
    arrivals_.resize(1);
    return;
  }
  endpoint_ ? endpoint_->forget(settings_.endpoint.handshake.incarnation)
            : static_cast<void>(endpoint_.emplace(settings_.endpoint));
  if (!settings_.roles) return;
  const RoleFormat& format = *settings_.roles->format;
  binder_.emplace(format.shape().skills, format.candidates(), settings_.roles->restarts);
  endpoint_->expect_nobody();
  arrivals_.resize(format.candidates());
}

void ProgramNode::crash() {
  ++settings_.endpoint.handshake.incarnation;
  const bool joined = candidate_ && candidate_->announces();
  if (candidate_) settings_.roles->offer->life = handshake::next_life(candidate_->announcement().life);
  begin();
  if (joined) candidate_->join();
}

ProgramEndpoint& ProgramNode::join(Nesting& nesting, Side side) {
  TAKT_CHECK(!settings_.roles || (side == Side::inner && binder_), "whoever joins two groups has its place in both");
  nesting_ = &nesting;
  side_ = side;
  endpoint_->join(nesting, side);
  return *endpoint_;
}

Turn ProgramNode::turn(sim::LocalTime now) {
  NodeOutputs& out = nesting_ == nullptr ? outputs_ : nesting_->outputs();
  out.status = program::StatusCode::Good;
  out.verdict = Verdict::taken;
  return {now, out};
}

std::size_t ProgramNode::alarm_count() const {
  return role_alarm() + (candidate_ ? 1 : binder_ ? 1 + settings_.roles->format->candidates() : 0);
}

NodeOutputs& ProgramNode::start(sim::LocalTime now) {
  const Turn turn = this->turn(now);
  if (endpoint_) endpoint_->start(turn);
  if (settings_.roles) turn.out.add(side_, SetAlarm{role_alarm(), now});
  return turn.out;
}

NodeOutputs& ProgramNode::call(sim::LocalTime now, program::Method method) {
  const Turn turn = this->turn(now);
  if (binder_) binder_->called();
  if (!endpoint_) {
    turn.out.status = program::StatusCode::BadInvalidState;
  } else if (binder_ && method == program::Method::Start && state() == handshake::PublishedState::Halted &&
             !binder_->complete()) {
    turn.out.status = program::StatusCode::BadResourceUnavailable;
  } else {
    turn.out.status = endpoint_->step(turn, Input::command(method)).status;
    settle(turn);
  }
  return turn.out;
}

NodeOutputs& ProgramNode::finished(sim::LocalTime now) {
  const Turn turn = this->turn(now);
  if (endpoint_) endpoint_->step(turn, Input::finished());
  settle(turn);
  return turn.out;
}

NodeOutputs& ProgramNode::publish_data(sim::LocalTime now, std::uint8_t data_set) {
  const Turn turn = this->turn(now);
  if (endpoint_) endpoint_->publish_data(turn, data_set);
  return turn.out;
}

NodeOutputs& ProgramNode::receive(sim::LocalTime now, uadp::Octets network_message) {
  const Turn turn = this->turn(now);
  if (settings_.roles) return receive_with_roles(turn, network_message);
  turn.out.verdict = endpoint_->receive(turn, network_message);
  return turn.out;
}

/// What other candidates announce is for the master, what a master sends in tables for candidates.
NodeOutputs& ProgramNode::receive_with_roles(const Turn& turn, uadp::Octets network_message) {
  const auto message = settings_.roles->format->decode(network_message);
  if (!message) {
    turn.out.verdict = endpoint_ ? endpoint_->receive(turn, network_message)
                       : settings_.endpoint.format->decode(network_message)
                           ? Verdict::unsubscribed
                           : settings_.endpoint.format->refusal_of(network_message);
    if (turn.out.verdict == Verdict::other_group)
      turn.out.verdict = settings_.roles->format->refusal_of(network_message);
  } else if (const auto* const announcement = std::get_if<AnnouncementMessage>(&*message)) {
    turn.out.verdict = !binder_ ? Verdict::unsubscribed : take(turn, *announcement) ? Verdict::taken : Verdict::stale;
    if (binder_ && turn.out.verdict != Verdict::taken) return turn.out;
  } else if (candidate_) {
    turn.out.verdict = take(turn, std::get<TableMessage>(*message)) ? Verdict::taken : Verdict::stale;
  } else {
    turn.out.verdict = Verdict::unsubscribed;
  }
  settle(turn);
  return turn.out;
}

NodeOutputs& ProgramNode::wake(sim::LocalTime now, std::size_t alarm) {
  const Turn turn = this->turn(now);
  if (!settings_.roles) {
    endpoint_->wake(turn, alarm);
    return turn.out;
  }
  if (alarm == role_alarm()) {
    candidate_ ? announce(turn) : publish_table(turn);
    turn.out.add(side_, SetAlarm{alarm, now + settings_.roles->announce_cycle});
    return turn.out;
  }
  if (alarm > role_alarm()) {
    binder_->silent(static_cast<std::uint8_t>(alarm - role_alarm() - 1));
  } else if (endpoint_) {  // else it is one of a role that it had
    if (const auto peer = endpoint_->peer_of_alarm(alarm); peer && binder_) binder_->role_silent(*peer);
    endpoint_->wake(turn, alarm);
  }
  settle(turn);
  return turn.out;
}

NodeOutputs& ProgramNode::join(sim::LocalTime now) {
  const Turn turn = this->turn(now);
  candidate_->join();
  announce(turn);
  return turn.out;
}

NodeOutputs& ProgramNode::leave(sim::LocalTime now) {
  const Turn turn = this->turn(now);
  candidate_->leave();
  announce(turn);
  return turn.out;
}

/// False for one that comes too late.
bool ProgramNode::take(const Turn& turn, const AnnouncementMessage& message) {
  const sim::Duration timeout = announce_timeout(settings_.roles->announce_cycle);
  if (!arrivals_[message.candidate].take(message.sequence, message.announcement.life, turn.now, timeout)) return false;
  if (binder_->announced(message.candidate, message.announcement))
    turn.out.add(side_, SetAlarm{role_alarm() + 1 + message.candidate, turn.now + timeout});
  return true;
}

bool ProgramNode::take(const Turn& turn, const TableMessage& message) {
  if (!arrivals_.front().take(message.sequence, message.incarnation, turn.now,
                              announce_timeout(settings_.roles->announce_cycle)))
    return false;
  const Binding before = self();
  const auto role = candidate_->role();
  // Lives that lie far apart have no order, so tables and announcements that are under way could chase each other for
  // ever; a node that changes its life once in a while only ends that.
  const std::uint32_t used_life = turn.now >= next_other_life_ ? message.used_lives[before.candidate] : 0;
  const Candidate::Change change =
      candidate_->table(std::span(message.bindings).first(settings_.roles->format->roles()), used_life);
  if (change == Candidate::Change::none && self() != before)
    next_other_life_ = turn.now + settings_.roles->announce_cycle;
  if (change == Candidate::Change::released) {
    endpoint_.reset();
    turn.out.add(side_, RoleDropped{*role, before});
  }
  if (change == Candidate::Change::bound) {
    read_role();
    turn.out.add(side_, RoleTaken{*candidate_->role(), before});
    endpoint_->start(turn);
  }
  if (self() != before) announce(turn);
  return true;
}

void ProgramNode::read_role() {
  EndpointSettings settings = settings_.endpoint;
  settings.handshake.role = handshake::Role::slave;
  settings.handshake.index = static_cast<std::uint8_t>(*candidate_->role() + 1);
  settings.handshake.incarnation = candidate_->incarnation();
  endpoint_.emplace(std::move(settings));
}

void ProgramNode::settle(const Turn& turn) {
  if (!binder_) return;
  nesting_ == nullptr ? static_cast<void>(stabilise_roles(turn)) : nesting_->settle(turn);
}

bool ProgramNode::stabilise_roles(const Turn& turn) {
  if (!binder_) return false;
  bool has_stepped = false;
  bool changed = false;
  while (const auto input = binder_->next(master_view_of(endpoint_->participant()))) {
    if (input->kind == Input::Kind::peer_replaced) {
      const Binding& binding = binder_->binding(input->peer);
      endpoint_->expect(input->peer, binding.bound()
                                         ? std::optional(handshake::incarnation_of(binding.candidate, binding.life))
                                         : std::nullopt);
      turn.out.add(side_, RoleBound{input->peer, binding});
      changed = true;
    }
    endpoint_->step(turn, *input);
    has_stepped = true;
  }
  if (changed) publish_table(turn);
  return has_stepped;
}

void ProgramNode::publish_table(const Turn& turn) {
  TableMessage message;
  message.sequence = sequence_++;
  message.incarnation = endpoint_->participant().config().incarnation;
  std::copy(binder_->bindings().begin(), binder_->bindings().end(), message.bindings.begin());
  for (std::uint8_t c = 0; c < binder_->candidates(); ++c) message.used_lives[c] = binder_->used_life(c);
  publish(turn, message, table_writer_group);
}

void ProgramNode::announce(const Turn& turn) {
  if (candidate_->announces())
    publish(turn, AnnouncementMessage{settings_.roles->offer->number, sequence_++, candidate_->announcement()},
            announcement_writer_group);
}

template <class Message>
void ProgramNode::publish(const Turn& turn, const Message& message, std::uint16_t writer_group) {
  const std::span<std::byte> target = turn.out.message();
  const std::size_t octets = settings_.roles->format->encode(message, target).size();
  turn.out.add(side_, Publish{target.first(octets), {writer_group, settings_.endpoint.priority}, message.sequence});
}

}  // namespace takt::wire
