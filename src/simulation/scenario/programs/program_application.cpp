// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/program_application.hpp"

#include <utility>

namespace takt::scenario {

ProgramApplication::ProgramApplication(Settings settings, ProgramMonitor& monitor, RoleMonitor* roles,
                                       models::NodeIndex host)
    : state_stream_(settings.state_stream),
      role_stream_(settings.role_stream),
      data_streams_(std::move(settings.data_streams)),
      sealed_(std::move(settings.sealed)),
      replies_(std::move(settings.replies)),
      monitor_(&monitor),
      roles_(roles),
      host_(host),
      node_(std::move(settings.node)),
      heard_(node_.peer_count()) {}

std::unique_ptr<wire::Nesting> ProgramApplication::nest(ProgramApplication& outer, models::HostServices& outer_host,
                                                        ProgramApplication& inner, models::HostServices& inner_host) {
  outer.other_ = &inner;
  outer.host_of_other_ = &inner_host;
  inner.other_ = &outer;
  inner.host_of_other_ = &outer_host;
  inner.side_ = handshake::Side::inner;
  return std::make_unique<wire::Nesting>(outer.node_, inner.node_);
}

void ProgramApplication::crash() {
  if (has_crashed_) return;
  has_crashed_ = true;
  const auto participant = node_.participant();
  const handshake::PublishedState before = node_.state();
  const auto self = is_candidate() ? std::optional(node_.self()) : std::nullopt;
  if (replies_) replies_->forget();
  node_.crash();
  if (!self)
    monitor_->on_crash(*participant, before);
  else if (participant)
    roles_->on_dropped(*participant - 1, *self, true);
}

/// A candidate is back when it is bound.
void ProgramApplication::restart(models::HostServices& host) {
  crash();
  has_crashed_ = false;
  if (sealed_) sealed_->restart();
  if (!is_candidate()) monitor_->on_back(*node_.participant(), host_.value);
  start(host);
}

void ProgramApplication::call(models::HostServices& host, program::Method method) {
  const auto participant = node_.participant();
  if (participant) monitor_->before_call();
  wire::NodeOutputs& outputs = node_.call(host.now(), method);
  carry_out(host, outputs);
  if (participant) monitor_->on_call(*participant, method, outputs.status);
}

std::optional<handshake::PublishedState> ProgramApplication::state_of(std::uint32_t life) const {
  return node_.participant() && node_.self().life == life ? std::optional(node_.state()) : std::nullopt;
}

void ProgramApplication::wake(models::HostServices& host, models::AlarmId alarm) {
  if (replies_ && alarm == work_alarm()) {
    end_work(host);
    return;
  }
  if (const auto* const endpoint = node_.endpoint())
    if (const auto peer = endpoint->peer_of_alarm(alarm))
      monitor_->on_silence(*node_.participant(), endpoint->participant().participant_of(*peer), heard_[*peer]);
  carry_out(host, node_.wake(host.now(), alarm));
}

/// What is refused is not heard.
void ProgramApplication::receive(models::HostServices& host, models::StreamIndex, std::span<const std::byte> payload) {
  const auto octets = sealed_ ? sealed_->open(payload) : std::optional<security::Octets>(payload);
  if (octets) carry_out(host, node_.receive(host.now(), *octets));
}

void ProgramApplication::carry_out(models::HostServices& host, wire::NodeOutputs& outputs) {
  outputs.carry_out([&](const wire::NodeOutputs::Entry& output) {
    const bool is_own = output.side == side_;
    ProgramApplication& of = is_own ? *this : *other_;
    models::HostServices& on = is_own ? host : *host_of_other_;
    std::visit([&](const auto& what) { of.act(on, what); }, output.what);
  });
}

void ProgramApplication::act(models::HostServices& host, const wire::Publish& message) {
  if (message.is_state()) {
    send(host, state_stream_, message.octets);
  } else if (message.is_of_roles()) {
    send(host, *role_stream_, message.octets);
  } else if (const auto& stream = data_streams_[message.data_set()]) {
    monitor_->on_published(message.data_set(), message.sequence);
    if (node_.endpoint()->settings().handshake.variant == handshake::Variant::paper)
      message.set_run(monitor_->sending_run(*node_.participant()));
    send(host, *stream, message.octets);
  }
}

void ProgramApplication::act(models::HostServices&, const wire::Stepped& step) {
  const std::size_t participant = *node_.participant();
  is_candidate() ? roles_->on_step(participant - 1, node_.self(), step.outputs, step.after)
                 : monitor_->on_step(participant, step.outputs, step.after);
}

void ProgramApplication::act(models::HostServices& host, const wire::ProcessDataMessage& message) {
  const std::size_t participant = *node_.participant();
  is_candidate() ? roles_->on_process_data(participant - 1, node_.self(), message.sender, message.run)
                 : monitor_->on_process_data(message.sender, participant, message.run);
  monitor_->on_data_received(message.data_set, message.sequence, participant);
  if (replies_ && replies_->answers(message.data_set))
    begin_work(host, replies_->take({message.data_set, message.sequence}));
}

void ProgramApplication::begin_work(models::HostServices& host, const std::optional<sim::Duration>& work) {
  if (work) host.work(static_cast<models::AlarmId>(work_alarm()), *work);
}

/// What was asked is answered, unless this participant has stopped in the meantime.
void ProgramApplication::end_work(models::HostServices& host) {
  const ReplyWorker::Done done = replies_->done();
  const std::span<const ResolvedReply> replies = replies_->replies();
  for (std::size_t i = 0; i < replies.size(); ++i) {
    const ResolvedReply& reply = replies[i];
    if (reply.to != done.request.data_set || !replies_->is_own(reply)) continue;
    wire::NodeOutputs& outputs = node_.publish_data(host.now(), reply.with);
    while (const auto* const output = outputs.next()) {
      const auto& message = std::get<wire::Publish>(output->what);
      act(host, message);
      monitor_->on_replied(i, message.sequence, done.request.sequence);
    }
  }
  begin_work(host, done.next);
}

}  // namespace takt::scenario
