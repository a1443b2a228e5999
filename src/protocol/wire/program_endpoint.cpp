// SPDX-License-Identifier: Apache-2.0
#include "wire/program_endpoint.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "wire/nesting.hpp"

namespace takt::wire {
namespace {

using handshake::Input;
using handshake::Outputs;

/// How many whole cycles have passed since local time 0 shifted by `offset`; negative before.
std::int64_t cycles_until(sim::LocalTime now, sim::Duration offset, sim::Duration cycle) {
  const sim::Duration passed = now.since_start() - offset;
  const std::int64_t whole = passed / cycle;
  return passed < sim::Duration() && cycle * whole != passed ? whole - 1 : whole;
}

}  // namespace

ProgramEndpoint::ProgramEndpoint(EndpointSettings settings)
    : settings_(std::move(settings)), participant_(settings_.handshake) {
  TAKT_CHECK(settings_.cycle > sim::Duration(), "a cycle lasts");
  TAKT_CHECK(settings_.format->participants() == settings_.handshake.slaves + std::size_t{1},
             "the format is that of the group");
  TAKT_CHECK(settings_.format->longest() <= most_message_octets, "a message fits into a frame");
  forget(settings_.handshake.incarnation);
  find_peers();
  for (std::size_t d = 0; d < data_.size(); ++d)
    if (settings_.format->shape().data_sets[d].from == settings_.handshake.index &&
        (settings_.on_demand.empty() || !settings_.on_demand[d]))
      cyclic_.push_back(static_cast<std::uint8_t>(d));
}

/// Which peer each participant is; they never change.
void ProgramEndpoint::find_peers() {
  peer_from_.assign(settings_.format->participants(), nobody);
  for (std::size_t peer = 0; peer < participant_.peer_count(); ++peer)
    peer_from_[participant_.participant_of(peer)] = static_cast<std::uint8_t>(peer);
}

void ProgramEndpoint::forget(std::uint32_t incarnation) {
  settings_.handshake.incarnation = incarnation;
  participant_ = handshake::Participant<64>(settings_.handshake);
  states_.assign(participant_.peer_count(), {});
  known_.assign(participant_.peer_count(), {});
  data_.assign(settings_.format->shape().data_sets.size(), {});
  data_sequence_.assign(data_.size(), 0);
  state_sequence_ = 0;
  initialisation_run_ = 0;
  if (nesting_ != nullptr) nesting_->forget();
}

void ProgramEndpoint::start(const Turn& turn) {
  // The first instant of the cycle that has not passed.
  next_cycle_ = cycles_until(turn.now - sim::Duration::from_ps(1), settings_.offset, settings_.cycle) + 1;
  set_cycle_alarm(turn);
}

void ProgramEndpoint::wake(const Turn& turn, std::size_t alarm) {
  if (alarm == cycle_alarm)
    cycle(turn);
  else if (alarm == initialised_alarm)
    nesting_ == nullptr ? static_cast<void>(step(turn, Input::initialised(initialisation_run_)))
                        : nesting_->initialised(turn, side_, initialisation_run_);
  else
    step(turn, Input::peer_silent(alarm - first_peer_alarm));
}

void ProgramEndpoint::cycle(const Turn& turn) {
  publish_state(turn);
  if (participant_.state() == handshake::PublishedState::Running) publish_process_data(turn);
  const std::int64_t due = cycles_until(turn.now, settings_.offset, settings_.cycle) + 1;
  if (due > next_cycle_ + 1) missed_cycles_ += static_cast<std::uint64_t>(due - next_cycle_ - 1);
  next_cycle_ = std::max(next_cycle_ + 1, due);
  set_cycle_alarm(turn);
}

void ProgramEndpoint::set_cycle_alarm(const Turn& turn) {
  turn.out.add(side_, SetAlarm{cycle_alarm, sim::LocalTime() + settings_.offset + settings_.cycle * next_cycle_});
}

Verdict ProgramEndpoint::receive(const Turn& turn, uadp::Octets network_message) {
  const ProgramFormat& format = *settings_.format;
  const auto sender = format.sender_of(network_message);
  const std::size_t peer = sender ? peer_from_[*sender] : nobody;
  if (peer != nobody) {
    // Nearly all states say what the one before said.
    if (known_[peer].is_repeated_by(network_message))
      return receive_state(turn, peer, known_[peer].message(static_cast<std::uint8_t>(*sender), network_message));
    if (ProcessDataMessage data; format.decode(network_message, data)) return receive_data(turn, peer, data);
  }
  const auto message = format.decode(network_message);
  if (!message) {
    ++counts_.foreign;
    return format.refusal_of(network_message);
  }
  if (peer == nobody) {
    ++counts_.unsubscribed;
    return Verdict::unsubscribed;
  }
  const auto& state = std::get<StateMessage>(*message);
  known_[peer].note(network_message, state.word);
  return receive_state(turn, peer, state);
}

void ProgramEndpoint::expect(std::size_t peer, std::optional<std::uint32_t> incarnation) {
  expected_[peer] = incarnation;
  states_[peer] = {};
}

void ProgramEndpoint::expect_nobody() { expected_.assign(participant_.peer_count(), std::nullopt); }

Verdict ProgramEndpoint::receive_state(const Turn& turn, std::size_t peer, const StateMessage& message) {
  if (!expected_.empty() && expected_[peer] != message.word.incarnation) {
    ++counts_.unsubscribed;
    return Verdict::unsubscribed;
  }
  if (!is_new(states_[peer], message.sequence, message.word.incarnation, turn.now)) return Verdict::stale;
  ++counts_.taken;
  turn.out.add(side_, Heard{peer, message.word});
  const Outputs outputs = participant_.step(Input::received(peer, message.word, message.sequence));
  if (outputs.is_quiet() && outputs.arm_timeout == handshake::PeerSet{1} << peer && nesting_ == nullptr) [[likely]]
    turn.out.add(side_, SetAlarm{first_peer_alarm + peer, turn.now + settings_.receive_timeout});
  else
    follow(turn, outputs);
  return Verdict::taken;
}

Verdict ProgramEndpoint::receive_data(const Turn& turn, std::size_t peer, const ProcessDataMessage& message) {
  const bool has_runs = settings_.handshake.variant == handshake::Variant::robust;
  const bool counts =
      has_runs ? participant_.process_data_counts(peer, message.run) : participant_.process_data_counts(peer);
  if (!counts) {
    ++counts_.not_running;
    return Verdict::not_running;
  }
  if (!is_new(data_[message.data_set], message.sequence, has_runs ? message.run : 0, turn.now)) return Verdict::stale;
  ++counts_.taken;
  turn.out.add(side_, message);
  return Verdict::taken;
}

bool ProgramEndpoint::is_new(Arrivals& arrivals, std::uint16_t sequence, std::uint32_t life, sim::LocalTime now) {
  const bool is_new = arrivals.take(sequence, life, now, settings_.receive_timeout);
  if (!is_new) ++counts_.stale;
  return is_new;
}

bool Arrivals::take(std::uint16_t sequence, std::uint32_t of_life, sim::LocalTime now, sim::Duration timeout) {
  if (life != of_life || now - last >= timeout) window.forget();
  if (window.take(sequence) != uadp::Sequence::newer) return false;
  life = of_life;
  last = now;
  return true;
}

Outputs ProgramEndpoint::step(const Turn& turn, const Input& input) {
  const Outputs outputs = participant_.step(input);
  follow(turn, outputs);
  return outputs;
}

/// A step has been taken: what its outputs ask for comes behind it.
void ProgramEndpoint::follow(const Turn& turn, const Outputs& outputs) {
  if (!outputs.is_quiet()) turn.out.add(side_, Stepped{outputs, participant_.word()});
  if (outputs.begin_initialisation) {
    initialisation_run_ = outputs.initialisation_run;
    turn.out.add(side_, SetAlarm{initialised_alarm, turn.now + settings_.initialisation});
  }
  for (handshake::PeerSet peers = outputs.arm_timeout; peers != 0; peers &= peers - 1)
    turn.out.add(side_, SetAlarm{first_peer_alarm + static_cast<std::size_t>(std::countr_zero(peers)),
                                 turn.now + settings_.receive_timeout});
  if (outputs.publish && settings_.publish_on_change) publish_state(turn);
  if (nesting_ != nullptr) nesting_->settle(turn);
}

void ProgramEndpoint::publish_state(const Turn& turn) {
  const StateMessage message{settings_.handshake.index, state_sequence_++, participant_.word()};
  const std::span<std::byte> target = turn.out.message();
  const std::size_t octets = settings_.format->encode(message, target).size();
  turn.out.add(side_,
               Publish{target.first(octets), {state_writer_group, settings_.priority}, message.sequence, message.word});
}

/// `paper` has no run.
bool ProgramEndpoint::publish_data(const Turn& turn, std::uint8_t data_set) {
  if (participant_.state() != handshake::PublishedState::Running) return false;
  const bool has_runs = settings_.handshake.variant == handshake::Variant::robust;
  const ProcessDataMessage message{
      settings_.handshake.index, data_set, data_sequence_[data_set]++, has_runs ? participant_.run() : 0, {}};
  const std::span<std::byte> target = turn.out.message();
  const std::size_t octets = settings_.format->encode(message, target).size();
  turn.out.add(side_, Publish{target.first(octets),
                              {static_cast<std::uint16_t>(first_data_writer_group + data_set), settings_.priority},
                              message.sequence});
  return true;
}

void ProgramEndpoint::publish_process_data(const Turn& turn) {
  for (const std::uint8_t data_set : cyclic_) publish_data(turn, data_set);
}

}  // namespace takt::wire
