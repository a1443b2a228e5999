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

ProgramEndpoint::ProgramEndpoint(EndpointSettings settings) : settings_(std::move(settings)), participant_(settings_.handshake) {
  TAKT_CHECK(settings_.cycle > sim::Duration(), "a cycle lasts");
  TAKT_CHECK(settings_.format->participants() == settings_.handshake.slaves + std::size_t{1}, "the format is that of the group");
  TAKT_CHECK(settings_.format->longest() <= buffer_.size(), "a message fits into a frame");
  forget(settings_.handshake.incarnation);
}

void ProgramEndpoint::forget(std::uint32_t incarnation) {
  settings_.handshake.incarnation = incarnation;
  participant_ = handshake::Participant<64>(settings_.handshake);
  states_.assign(participant_.peer_count(), {});
  data_.assign(settings_.format->shape().data_sets.size(), {});
  data_sequence_.assign(data_.size(), 0);
  state_sequence_ = 0;
  initialisation_run_ = 0;
  if (nesting_ != nullptr) nesting_->forget();
}

void ProgramEndpoint::start(EndpointHost& host) {
  // The first instant of the cycle that has not passed.
  next_cycle_ = cycles_until(host.now() - sim::Duration::from_ps(1), settings_.offset, settings_.cycle) + 1;
  set_cycle_alarm(host);
}

program::StatusCode ProgramEndpoint::call(EndpointHost& host, program::Method method) { return step(host, Input::command(method)).status; }

void ProgramEndpoint::wake(EndpointHost& host, std::size_t alarm) {
  if (alarm == cycle_alarm)
    cycle(host);
  else if (alarm == initialised_alarm)
    nesting_ == nullptr ? static_cast<void>(step(host, Input::initialised(initialisation_run_))) : nesting_->initialised(*this, initialisation_run_);
  else
    step(host, Input::peer_silent(alarm - first_peer_alarm));
}

void ProgramEndpoint::cycle(EndpointHost& host) {
  publish_state(host);
  if (participant_.state() == handshake::PublishedState::Running) publish_process_data(host);
  const std::int64_t due = cycles_until(host.now(), settings_.offset, settings_.cycle) + 1;
  if (due > next_cycle_ + 1) missed_cycles_ += static_cast<std::uint64_t>(due - next_cycle_ - 1);
  next_cycle_ = std::max(next_cycle_ + 1, due);
  set_cycle_alarm(host);
}

void ProgramEndpoint::set_cycle_alarm(EndpointHost& host) {
  host.set_alarm(cycle_alarm, sim::LocalTime() + settings_.offset + settings_.cycle * next_cycle_);
}

void ProgramEndpoint::receive(EndpointHost& host, uadp::Octets network_message) {
  const auto message = settings_.format->decode(network_message);
  if (!message) {
    ++counts_.foreign;
    return;
  }
  const std::uint8_t sender = std::visit([](const auto& m) { return m.sender; }, *message);
  const std::size_t peer = sender == settings_.handshake.index ? participant_.peer_count() : participant_.peer_of(sender);
  if (peer >= participant_.peer_count() || participant_.participant_of(peer) != sender) {
    ++counts_.unsubscribed;
    return;
  }
  if (const auto* const state = std::get_if<StateMessage>(&*message))
    receive_state(host, peer, *state);
  else
    receive_data(host, peer, std::get<ProcessDataMessage>(*message));
}

void ProgramEndpoint::expect(std::size_t peer, std::optional<std::uint32_t> incarnation) {
  expected_[peer] = incarnation;
  states_[peer] = {};
}

void ProgramEndpoint::expect_nobody() { expected_.assign(participant_.peer_count(), std::nullopt); }

void ProgramEndpoint::receive_state(EndpointHost& host, std::size_t peer, const StateMessage& message) {
  if (!expected_.empty() && expected_[peer] != message.word.incarnation) {
    ++counts_.unsubscribed;
    return;
  }
  if (!is_new(states_[peer], message.sequence, message.word.incarnation, host.now())) return;
  ++counts_.taken;
  host.heard(peer, message.word);
  step(host, Input::received(peer, message.word, message.sequence));
}

void ProgramEndpoint::receive_data(EndpointHost& host, std::size_t peer, const ProcessDataMessage& message) {
  const bool has_runs = settings_.handshake.variant == handshake::Variant::Robust;
  const bool counts = has_runs ? participant_.process_data_counts(peer, message.run) : participant_.process_data_counts(peer);
  if (!counts) {
    ++counts_.not_running;
    return;
  }
  if (!is_new(data_[message.data_set], message.sequence, has_runs ? message.run : 0, host.now())) return;
  ++counts_.taken;
  host.process_data(message);
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

/// Takes one step of the handshake and does what its outputs ask for.
Outputs ProgramEndpoint::step(EndpointHost& host, const Input& input) {
  const Outputs outputs = participant_.step(input);
  host.stepped(outputs, participant_.word());
  if (outputs.begin_initialisation) {
    initialisation_run_ = outputs.initialisation_run;
    host.set_alarm(initialised_alarm, host.now() + settings_.initialisation);
  }
  for (handshake::PeerSet peers = outputs.arm_timeout; peers != 0; peers &= peers - 1)
    host.set_alarm(first_peer_alarm + static_cast<std::size_t>(std::countr_zero(peers)), host.now() + settings_.receive_timeout);
  if (outputs.publish && settings_.publish_on_change) publish_state(host);
  if (nesting_ != nullptr) nesting_->settle();
  return outputs;
}

void ProgramEndpoint::publish_state(EndpointHost& host) {
  const StateMessage message{settings_.handshake.index, state_sequence_++, participant_.word()};
  host.publish(settings_.format->encode(message, buffer_), {state_writer_group, settings_.priority});
}

bool ProgramEndpoint::publish_data(EndpointHost& host, std::uint8_t data_set) {
  if (participant_.state() != handshake::PublishedState::Running) return false;
  const bool has_runs = settings_.handshake.variant == handshake::Variant::Robust;
  const std::uint32_t run = has_runs ? participant_.run() : host.run_of_paper();
  const uadp::Octets octets =
      settings_.format->encode(ProcessDataMessage{settings_.handshake.index, data_set, data_sequence_[data_set]++, run, {}}, buffer_);
  host.fill(data_set, std::span(buffer_).subspan(process_data_octets(0), octets.size() - process_data_octets(0)));
  host.publish(octets, {static_cast<std::uint16_t>(first_data_writer_group + data_set), settings_.priority});
  return true;
}

void ProgramEndpoint::publish_process_data(EndpointHost& host) {
  for (std::size_t d = 0; d < data_sequence_.size(); ++d) {
    if (settings_.format->shape().data_sets[d].from != settings_.handshake.index) continue;
    if (settings_.on_demand.empty() || !settings_.on_demand[d]) publish_data(host, static_cast<std::uint8_t>(d));
  }
}

}  // namespace takt::wire
