#include "scenario/program_application.hpp"

#include <utility>

namespace takt::scenario {

using handshake::Input;
using handshake::Outputs;

ProgramApplication::ProgramApplication(Settings settings, ProgramMonitor& monitor)
    : settings_(std::move(settings)), monitor_(&monitor), participant_(settings_.handshake) {}

void ProgramApplication::start(models::HostServices& host) { host.set_alarm(cycle_alarm, sim::LocalTime() + settings_.offset); }

void ProgramApplication::call(models::HostServices& host, program::Method method) {
  const Outputs outputs = step(host, Input::command(method));
  monitor_->on_call(settings_.handshake.index, method, outputs.status);
}

void ProgramApplication::wake(models::HostServices& host, models::AlarmId alarm) {
  if (alarm == cycle_alarm)
    cycle(host);
  else if (alarm == initialised_alarm)
    step(host, Input::initialised(initialisation_run_));
  else
    step(host, Input::peer_silent(static_cast<std::size_t>(alarm - first_peer_alarm)));
}

void ProgramApplication::cycle(models::HostServices& host) {
  publish_state(host);
  if (participant_.state() == handshake::PublishedState::Running) publish_process_data(host);
  ++cycles_;
  host.set_alarm(cycle_alarm, sim::LocalTime() + settings_.offset + settings_.cycle * cycles_);
}

void ProgramApplication::receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) {
  const auto message = wire::decode(payload);
  if (!message) return;
  const std::uint8_t sender = std::visit([](const auto& m) { return m.sender; }, *message);
  const std::size_t peer = participant_.peer_of(sender);
  if (peer >= participant_.peer_count()) return;  // not of this group
  if (const auto* state = std::get_if<wire::StateMessage>(&*message)) {
    step(host, Input::received(peer, state->word, state->sequence));
    return;
  }
  const auto& data = std::get<wire::ProcessDataMessage>(*message);
  const bool counts = settings_.handshake.variant == handshake::Variant::Robust ? participant_.process_data_counts(peer, data.run)
                                                                                : participant_.process_data_counts(peer);
  if (counts) monitor_->on_process_data(data.sender, settings_.handshake.index, data.run);
}

/// Takes one step of the handshake and does what its outputs ask for.
Outputs ProgramApplication::step(models::HostServices& host, const Input& input) {
  const Outputs outputs = participant_.step(input);
  monitor_->on_step(settings_.handshake.index, outputs, participant_.word());
  if (outputs.begin_initialisation) {
    initialisation_run_ = outputs.initialisation_run;
    host.set_alarm(initialised_alarm, host.now() + settings_.initialisation);
  }
  for (handshake::PeerSet peers = outputs.arm_timeout; peers != 0; peers &= peers - 1) {
    const auto peer = static_cast<unsigned>(__builtin_ctzll(peers));
    host.set_alarm(static_cast<models::AlarmId>(first_peer_alarm + peer), host.now() + settings_.receive_timeout);
  }
  if (outputs.publish && settings_.publish_on_change) publish_state(host);
  return outputs;
}

void ProgramApplication::publish_state(models::HostServices& host) {
  host.send(settings_.state_stream, wire::encode(wire::StateMessage{settings_.handshake.index, state_sequence_++, participant_.word()}, buffer_));
}

void ProgramApplication::publish_process_data(models::HostServices& host) {
  // `paper` has no run; the observer's epoch goes with the data so that S3 can be checked. No participant reads it.
  const std::uint32_t run = monitor_->sending_run(settings_.handshake.index);
  for (DataSet& set : settings_.data_sets)
    host.send(set.stream, wire::encode(wire::ProcessDataMessage{settings_.handshake.index, set.number, set.sequence++, run}, set.field_octets, buffer_));
}

}  // namespace takt::scenario
